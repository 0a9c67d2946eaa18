#include "tests/benchmark/cgal_timing.h"

#define CGAL_LINKED_WITH_TBB
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <vector>

#include "src/delaunay/common/schedule.h"
#include "src/geometry/box.h"

namespace spillway::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

}  // namespace

template <>
Timing time_cgal_sequential<2>(std::span<const Point<2>> points) {
  std::vector<Kernel::Point_2> input;
  for (const auto& p : points) input.emplace_back(p[0], p[1]);
  Timing timing{};
  {
    const Stopwatch watch(timing.seconds);
    const ProcessorStopwatch processor(timing.processor_seconds);
    const CGAL::Delaunay_triangulation_2<Kernel> delaunay(input.begin(), input.end());
    timing.simplices = delaunay.number_of_faces();
  }
  return timing;
}

template <>
Timing time_cgal_sequential<3>(std::span<const Point<3>> points) {
  std::vector<Kernel::Point_3> input;
  for (const auto& p : points) input.emplace_back(p[0], p[1], p[2]);
  Timing timing{};
  {
    const Stopwatch watch(timing.seconds);
    const ProcessorStopwatch processor(timing.processor_seconds);
    const CGAL::Delaunay_triangulation_3<Kernel> delaunay(input.begin(), input.end());
    timing.simplices = delaunay.number_of_finite_cells();
  }
  return timing;
}

Timing time_cgal_parallel(std::span<const Point<3>> points, unsigned threads) {
  using Tds = CGAL::Triangulation_data_structure_3<CGAL::Triangulation_vertex_base_3<Kernel>,
                                                   CGAL::Delaunay_triangulation_cell_base_3<Kernel>,
                                                   CGAL::Parallel_tag>;
  using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, Tds>;
  constexpr int kLockCellsPerAxis = 50;  // CGAL's manual
  std::vector<Kernel::Point_3> input;
  Box<3> box;
  for (const auto& p : points) {
    input.emplace_back(p[0], p[1], p[2]);
    box.expand(p);
  }
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(static_cast<int>(threads));
  Timing timing{};
  arena.execute([&] {
    const Stopwatch watch(timing.seconds);
    Delaunay::Lock_data_structure locks(
        CGAL::Bbox_3(box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1], box.hi[2]),
        kLockCellsPerAxis);
    const Delaunay delaunay(input.begin(), input.end(), &locks);
    timing.simplices = delaunay.number_of_finite_cells();
  });
  return timing;
}

}  // namespace spillway::test

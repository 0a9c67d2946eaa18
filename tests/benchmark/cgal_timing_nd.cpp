// CGAL's triangulations of more than three dimensions, which need Eigen.

#include <CGAL/Delaunay_triangulation.h>
#include <CGAL/Epick_d.h>
#include <CGAL/spatial_sort.h>

#include <vector>

#include "src/delaunay/common/schedule.h"
#include "tests/benchmark/cgal_timing.h"

namespace spillway::test {

template <int D>
Timing time_cgal_sequential(std::span<const Point<D>> points) {
  using Kernel = CGAL::Epick_d<CGAL::Dimension_tag<D>>;
  std::vector<typename Kernel::Point_d> input;
  for (const auto& p : points) input.emplace_back(p.begin(), p.end());
  Timing timing{};
  {
    const Stopwatch watch(timing.seconds);
    const ProcessorStopwatch processor(timing.processor_seconds);
    CGAL::Delaunay_triangulation<Kernel> delaunay(D);
    delaunay.insert(input.begin(), input.end());  // sorts them
    timing.simplices = delaunay.number_of_finite_full_cells();
  }
  return timing;
}

template Timing time_cgal_sequential<4>(std::span<const Point<4>>);
template Timing time_cgal_sequential<5>(std::span<const Point<5>>);
template Timing time_cgal_sequential<6>(std::span<const Point<6>>);

}  // namespace spillway::test

#include "tests/library/cgal_periodic.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Periodic_2_Delaunay_triangulation_2.h>
#include <CGAL/Periodic_2_Delaunay_triangulation_traits_2.h>
#include <CGAL/Periodic_3_Delaunay_triangulation_3.h>
#include <CGAL/Periodic_3_Delaunay_triangulation_traits_3.h>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace spillway::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

template <int D>
struct Cgal;

template <>
struct Cgal<2> {
  using Delaunay = CGAL::Periodic_2_Delaunay_triangulation_2<
      CGAL::Periodic_2_Delaunay_triangulation_traits_2<Kernel>>;
  static Kernel::Point_2 point(const Point<2>& p) { return {p[0], p[1]}; }
  static Point<2> coordinates(const Kernel::Point_2& p) { return {p.x(), p.y()}; }
  static Delaunay::Iso_rectangle domain(const Extent& box) {
    return {box.low[0], box.low[1], box.high[0], box.high[1]};
  }
  static bool is_one_sheet(const Delaunay& d) { return d.is_1_cover(); }
  static auto begin(const Delaunay& d) { return d.faces_begin(); }
  static auto end(const Delaunay& d) { return d.faces_end(); }
};

template <>
struct Cgal<3> {
  using Delaunay = CGAL::Periodic_3_Delaunay_triangulation_3<
      CGAL::Periodic_3_Delaunay_triangulation_traits_3<Kernel>>;
  static Kernel::Point_3 point(const Point<3>& p) { return {p[0], p[1], p[2]}; }
  static Point<3> coordinates(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }
  static Delaunay::Iso_cuboid domain(const Extent& box) {
    return {box.low[0], box.low[1], box.low[2], box.high[0], box.high[1], box.high[2]};
  }
  static bool is_one_sheet(const Delaunay& d) { return d.is_triangulation_in_1_sheet(); }
  static auto begin(const Delaunay& d) { return d.cells_begin(); }
  static auto end(const Delaunay& d) { return d.cells_end(); }
};

}  // namespace

template <int D>
std::vector<std::array<VertexId, D + 1>> cgal_periodic_simplices(std::span<const Point<D>> points,
                                                                 const PeriodicBox& box) {
  typename Cgal<D>::Delaunay delaunay(Cgal<D>::domain(box.box));
  std::map<Point<D>, VertexId> numbers;
  std::vector<decltype(Cgal<D>::point({}))> input;
  for (const Point<D>& point : points) {
    numbers.emplace(point, static_cast<VertexId>(input.size()));
    input.push_back(Cgal<D>::point(point));
  }
  delaunay.insert(input.begin(), input.end(), true);  // a large set
  if (!Cgal<D>::is_one_sheet(delaunay)) {
    throw std::runtime_error("too few points for one copy of the box");
  }
  std::vector<std::array<VertexId, D + 1>> simplices;
  for (auto cell = Cgal<D>::begin(delaunay); cell != Cgal<D>::end(delaunay); ++cell) {
    auto& simplex = simplices.emplace_back();
    for (int i = 0; i <= D; ++i) {
      simplex[i] = numbers.at(Cgal<D>::coordinates(cell->vertex(i)->point()));
    }
    std::sort(simplex.begin(), simplex.end());
  }
  std::sort(simplices.begin(), simplices.end());
  return simplices;
}

template std::vector<std::array<VertexId, 3>> cgal_periodic_simplices<2>(std::span<const Point<2>>,
                                                                         const PeriodicBox&);
template std::vector<std::array<VertexId, 4>> cgal_periodic_simplices<3>(std::span<const Point<3>>,
                                                                         const PeriodicBox&);

}  // namespace spillway::test

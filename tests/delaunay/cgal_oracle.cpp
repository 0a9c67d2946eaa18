#include "tests/delaunay/cgal_oracle.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <numeric>

namespace spillway::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

template <int D>
struct Cgal;

template <>
struct Cgal<2> {
  using Vertex = CGAL::Triangulation_vertex_base_with_info_2<VertexId, Kernel>;
  using Delaunay =
      CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex>>;
  static Kernel::Point_2 point(const Point<2>& p) { return {p[0], p[1]}; }
  static auto cells(const Delaunay& d) { return d.finite_face_handles(); }
  static std::size_t all_cells(const Delaunay& d) { return d.all_face_handles().size(); }
};

template <>
struct Cgal<3> {
  using Vertex = CGAL::Triangulation_vertex_base_with_info_3<VertexId, Kernel>;
  using Cell = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
  using Delaunay =
      CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
  static Kernel::Point_3 point(const Point<3>& p) { return {p[0], p[1], p[2]}; }
  static auto cells(const Delaunay& d) { return d.finite_cell_handles(); }
  static std::size_t all_cells(const Delaunay& d) { return d.all_cell_handles().size(); }
};

template <int D>
typename Cgal<D>::Delaunay triangulate(std::span<const Point<D>> points) {
  std::vector<VertexId> order(points.size());
  std::iota(order.begin(), order.end(), VertexId{0});
  std::sort(order.begin(), order.end(), [&](VertexId a, VertexId b) {
    return points[a] != points[b] ? points[a] < points[b] : a < b;
  });
  order.erase(std::unique(order.begin(), order.end(),
                          [&](VertexId a, VertexId b) { return points[a] == points[b]; }),
              order.end());
  std::vector<std::pair<decltype(Cgal<D>::point({})), VertexId>> input;
  for (const VertexId i : order) input.emplace_back(Cgal<D>::point(points[i]), i);
  return {input.begin(), input.end()};
}

}  // namespace

template <int D>
std::vector<std::array<VertexId, D + 1>> cgal_simplices(std::span<const Point<D>> points) {
  const auto delaunay = triangulate<D>(points);
  std::vector<std::array<VertexId, D + 1>> simplices;
  if (delaunay.dimension() < D) return simplices;
  for (const auto cell : Cgal<D>::cells(delaunay)) {
    auto& simplex = simplices.emplace_back();
    for (int i = 0; i <= D; ++i) simplex[i] = cell->vertex(i)->info();
    std::sort(simplex.begin(), simplex.end());
  }
  std::sort(simplices.begin(), simplices.end());
  return simplices;
}

template <int D>
std::size_t cgal_hull_facets(std::span<const Point<D>> points) {
  const auto delaunay = triangulate<D>(points);
  if (delaunay.dimension() < D) return 0;
  return Cgal<D>::all_cells(delaunay) -
         static_cast<std::size_t>(
             std::distance(Cgal<D>::cells(delaunay).begin(), Cgal<D>::cells(delaunay).end()));
}

template std::vector<std::array<VertexId, 3>> cgal_simplices<2>(std::span<const Point<2>>);
template std::vector<std::array<VertexId, 4>> cgal_simplices<3>(std::span<const Point<3>>);
template std::size_t cgal_hull_facets<2>(std::span<const Point<2>>);
template std::size_t cgal_hull_facets<3>(std::span<const Point<3>>);

}  // namespace spillway::test

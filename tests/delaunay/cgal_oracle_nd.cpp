// CGAL's triangulations of more than three dimensions, apart from the others because they compile
// slowly and need Eigen.

#include <CGAL/Delaunay_triangulation.h>
#include <CGAL/Epick_d.h>

#include <algorithm>

#include "tests/delaunay/cgal_oracle.h"

namespace spillway::test {
namespace {

template <int D>
struct Cgal {
  using Tag = CGAL::Dimension_tag<D>;
  using Kernel = CGAL::Epick_d<Tag>;
  using Vertex = CGAL::Triangulation_vertex<Kernel, VertexId>;
  using Cell = CGAL::Triangulation_full_cell<Kernel>;
  using Structure = CGAL::Triangulation_data_structure<Tag, Vertex, Cell>;
  using Delaunay = CGAL::Delaunay_triangulation<Kernel, Structure>;
};

template <int D>
typename Cgal<D>::Delaunay triangulate(std::span<const Point<D>> points) {
  typename Cgal<D>::Delaunay delaunay(D);
  typename Cgal<D>::Delaunay::Vertex_handle near{};
  for (VertexId i = 0; i < points.size(); ++i) {
    const typename Cgal<D>::Kernel::Point_d point(points[i].begin(), points[i].end());
    const std::size_t before = delaunay.number_of_vertices();
    near = i == 0 ? delaunay.insert(point) : delaunay.insert(point, near);
    if (delaunay.number_of_vertices() > before) near->data() = i;  // of equal points the first
  }
  return delaunay;
}

}  // namespace

template <int D>
std::vector<std::array<VertexId, D + 1>> cgal_simplices(std::span<const Point<D>> points) {
  const auto delaunay = triangulate<D>(points);
  std::vector<std::array<VertexId, D + 1>> simplices;
  if (delaunay.current_dimension() < D) return simplices;
  for (auto cell = delaunay.finite_full_cells_begin(); cell != delaunay.finite_full_cells_end();
       ++cell) {
    auto& simplex = simplices.emplace_back();
    for (int i = 0; i <= D; ++i) simplex[i] = cell->vertex(i)->data();
    std::ranges::sort(simplex);
  }
  std::ranges::sort(simplices);
  return simplices;
}

template std::vector<std::array<VertexId, 5>> cgal_simplices<4>(std::span<const Point<4>>);
template std::vector<std::array<VertexId, 6>> cgal_simplices<5>(std::span<const Point<5>>);
template std::vector<std::array<VertexId, 7>> cgal_simplices<6>(std::span<const Point<6>>);

}  // namespace spillway::test

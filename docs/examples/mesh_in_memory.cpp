// Triangulates points in memory; finds neighbours, the hull, and points that are equal.
#include <spillway/delaunay.h>

#include <cstdio>
#include <vector>

int main() {
  const std::vector<spillway::Point<2>> points{{0, 0}, {4, 0}, {4, 3}, {0, 3}, {1, 1}, {4, 0}};
  const spillway::Delaunay<2> mesh(points);

  std::printf("%zu triangles\n", mesh.cell_count());
  for (const auto cell : mesh.cells()) {
    int inner_edges = 0;
    for (const int neighbour : cell.neighbours) inner_edges += neighbour >= 0 ? 1 : 0;
    std::printf("corners %d %d %d, %d neighbours\n", cell.vertices[0], cell.vertices[1],
                cell.vertices[2], inner_edges);
  }
  std::printf("%zu edges on the hull\n", mesh.hull_facets().size() / 2);
  for (const auto& [point, vertex] : mesh.duplicates()) {
    std::printf("point %d equals point %d\n", point, vertex);
  }
}

// Asks a mesh: which triangle has a place, which vertex is nearest, what height is there.
#include <spillway/delaunay.h>

#include <cmath>
#include <cstdio>
#include <vector>

int main() {
  std::vector<spillway::Point<2>> points;
  std::vector<double> heights;
  for (int x = 0; x <= 100; ++x) {
    for (int y = 0; y <= 100; ++y) {
      points.push_back({double(x), double(y)});
      heights.push_back(2.0 * x + y);
    }
  }
  const spillway::Delaunay<2> mesh(points, {.threads = 2});

  const std::vector<spillway::Point<2>> places{{10.5, 20.25}, {99.75, 0}, {-7, 50}};
  const std::vector<int> triangles = mesh.locate(places);
  const std::vector<int> nearest = mesh.nearest_vertex(places);
  const std::vector<double> found = mesh.interpolate(heights, places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& [x, y] = points[nearest[i]];
    std::printf("(%g, %g): nearest vertex (%g, %g), ", places[i][0], places[i][1], x, y);
    if (triangles[i] >= 0) {
      std::printf("height %g\n", found[i]);
    } else {
      std::printf("outside of the mesh\n");  // the height is not a number
    }
  }
}

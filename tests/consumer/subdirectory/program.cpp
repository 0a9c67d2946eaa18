#include <spillway/delaunay.h>

#include <cstdio>
#include <vector>

int main() {
  const std::vector<spillway::Point<2>> points{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::printf("%zu triangles\n", spillway::Delaunay<2>(points).cell_count());
}

// Triangulates points with CGAL, for tests of the whole command.
//
//     cgal_mesh DIMENSION < points > simplices
//
// Points are doubles, DIMENSION of each, and simplices are uint32, DIMENSION + 1 of each: the sorted
// numbers of their corners, the whole list sorted. There is none if the points span fewer dimensions.
// Of 4 to 6 dimensions it is Spillway's set only where no D + 2 points are cospherical.

#include <cstdint>
#include <cstdio>
#include <exception>
#include <string_view>
#include <vector>

#include "tests/delaunay/cgal_oracle.h"

namespace spillway::test {
namespace {

template <int D>
int triangulate() {
  std::vector<Point<D>> points;
  Point<D> point;
  while (std::fread(point.data(), sizeof(double), D, stdin) == D) points.push_back(point);
  const auto simplices = cgal_simplices<D>(points);
  for (const auto& simplex : simplices) {
    if (std::fwrite(simplex.data(), sizeof(VertexId), D + 1, stdout) != D + 1) return 1;
  }
  return std::fflush(stdout) == 0 ? 0 : 1;
}

int run(std::string_view dimension) {
  if (dimension == "2") return triangulate<2>();
  if (dimension == "3") return triangulate<3>();
  if (dimension == "4") return triangulate<4>();
  std::fputs("usage: cgal_mesh 2|3|4 < points > simplices\n", stderr);
  return 2;
}

}  // namespace
}  // namespace spillway::test

int main(int count, char** arguments) {
  try {
    return spillway::test::run(count == 2 ? arguments[1] : "");
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "cgal_mesh: %s\n", fault.what());
    return 1;
  }
}

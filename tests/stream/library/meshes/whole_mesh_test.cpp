// A mesh in memory as a stream of one block.

#include "stream/library/meshes/whole_mesh.h"

#include <gtest/gtest.h>

namespace spillway::detail {
namespace {

TEST(WholeMesh, CountsFacetsThatOneSimplexHasAlone) {
  Mesh square;
  square.header.dimension = 2;
  square.corners = {0, 1, 2, 0, 2, 3};
  EXPECT_EQ(count_boundary_facets(square), 4U);
  Mesh tetrahedra;
  tetrahedra.header.dimension = 3;
  tetrahedra.corners = {0, 1, 2, 3, 1, 2, 3, 4};
  EXPECT_EQ(count_boundary_facets(tetrahedra), 6U);
}

}  // namespace
}  // namespace spillway::detail

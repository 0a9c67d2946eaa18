#include "src/delaunay/base_case/affine_basis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace spillway::test {
namespace {

TEST(AffineBasis, TellsTheDimensionOfTheHull) {
  EXPECT_EQ(affine_basis<2>({}).size(), 0U);
  using P2 = std::vector<Point<2>>;
  EXPECT_EQ(affine_basis<2>(P2{{1, 1}, {1, 1}}).size(), 1U);
  EXPECT_EQ(affine_basis<2>(P2{{1, 1}, {2, 2}, {3, 3}}).size(), 2U);
  EXPECT_THAT(affine_basis<2>(P2{{1, 1}, {2, 2}, {3, 3}, {3, 4}}), ::testing::ElementsAre(0, 1, 3));
  using P3 = std::vector<Point<3>>;
  EXPECT_EQ(affine_basis<3>(P3{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}}).size(), 2U);
  EXPECT_EQ(affine_basis<3>(P3{{0, 0, 5}, {1, 2, 5}, {2, 1, 5}, {7, 7, 5}}).size(), 3U);
  EXPECT_EQ(affine_basis<3>(P3{{0, 0, 5}, {1, 2, 5}, {2, 1, 5}, {7, 7, 6}}).size(), 4U);
}

TEST(AffineBasis, IsExactForNearlyCollinearPoints) {
  const double next = std::nextafter(0.5, 1);
  using P2 = std::vector<Point<2>>;
  EXPECT_EQ(affine_basis<2>(P2{{0, 0}, {1, 1}, {0.5, 0.5}}).size(), 2U);
  EXPECT_EQ(affine_basis<2>(P2{{0, 0}, {1, 1}, {0.5, next}}).size(), 3U);
}

}  // namespace
}  // namespace spillway::test

// Points of the engine and of programs: output coordinates on one side, a source's own on the
// other.

#include "stream/library/points/public_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;

TEST(PublicPoints, AreInOutputCoordinates) {
  const std::vector<LatticePoint> points = {{2, 4, 1}, {0, 0, 0}};
  EXPECT_THAT(public_points(IntegerLattice{{0.5, 0.25, 2}, {10, 20, 30}}, points),
              ElementsAre(Point<3>{11, 21, 32}, Point<3>{10, 20, 30}));
  EXPECT_THAT(public_points(std::nullopt, points),
              ElementsAre(Point<3>{2, 4, 1}, Point<3>{0, 0, 0}));
}

TEST(PublicPoints, OfAProgramAreTakenAsTheyAre) {
  EXPECT_THAT(points_without_lattice(std::vector<Point<3>>{{0.5, 1, 2}, {3, 4, 5}}),
              ElementsAre(LatticePoint{0.5, 1, 2}, LatticePoint{3, 4, 5}));
}

}  // namespace
}  // namespace spillway::test

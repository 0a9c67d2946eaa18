// How long a degree is.

#include "src/terrain/ground_scale.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spillway::test {
namespace {

constexpr GroundScale kWgs84{.degrees = 1, .semi_major = 6378137, .flattening = 1 / 298.257223563};

TEST(GroundScale, DegreesHaveTheLengthsOfTheirLatitude) {
  // Lengths of a degree of WGS 84, as tables of geodesy have them.
  EXPECT_NEAR(lengths_at(kWgs84, 0)[0], 111319.49, 0.01);
  EXPECT_NEAR(lengths_at(kWgs84, 0)[1], 110574.28, 0.01);
  EXPECT_NEAR(lengths_at(kWgs84, 45)[0], 78846.835, 0.01);
  EXPECT_NEAR(lengths_at(kWgs84, 45)[1], 111131.78, 0.01);
  EXPECT_NEAR(lengths_at(kWgs84, -60)[0], 55800.00, 0.01);
  EXPECT_EQ(lengths_at(kWgs84, -45), lengths_at(kWgs84, 45));
}

TEST(GroundScale, OfGradsAreNineTenths) {
  GroundScale grads = kWgs84;
  grads.degrees = 0.9;
  EXPECT_NEAR(lengths_at(grads, 50)[0], 0.9 * lengths_at(kWgs84, 45)[0], 1e-6);
}

TEST(GroundScale, PolesHaveLengthsThatAreNoZeros) {
  EXPECT_GT(lengths_at(kWgs84, 90)[0], 0);
  EXPECT_GT(lengths_at(kWgs84, -1000)[0], 0);
}

TEST(GroundScale, OfLengthsIsOne) {
  EXPECT_EQ(lengths_at({}, 1234), (Point<2>{1, 1}));
  EXPECT_TRUE(GroundScale{}.changes_nothing());
  EXPECT_FALSE(GroundScale{.height = 0.3048}.changes_nothing());
  EXPECT_FALSE(kWgs84.changes_nothing());
}

}  // namespace
}  // namespace spillway::test

// Sines and cosines that are the same on every machine.

#include "src/generators/direction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace spillway::test {
namespace {

TEST(Direction, OfQuarterTurnsIsExact) {
  for (const double whole : {0.0, 1.0, -3.0, 1e6}) {
    EXPECT_EQ(direction_at(whole).cosine, 1);
    EXPECT_EQ(direction_at(whole).sine, 0);
    EXPECT_EQ(direction_at(whole + 0.25).cosine, 0);
    EXPECT_EQ(direction_at(whole + 0.25).sine, 1);
    EXPECT_EQ(direction_at(whole + 0.5).cosine, -1);
    EXPECT_EQ(direction_at(whole - 0.25).sine, -1);
  }
}

TEST(Direction, IsThatOfTheLibraryToAFewUnitsInTheLastPlace) {
  for (int i = -3000; i <= 3000; ++i) {
    const double turns = i / 2048.0;  // exact, so only the library's angle is rounded
    const Direction direction = direction_at(turns);
    const double angle = 2 * std::numbers::pi * turns;
    EXPECT_NEAR(direction.cosine, std::cos(angle), 2e-15) << turns;
    EXPECT_NEAR(direction.sine, std::sin(angle), 2e-15) << turns;
    EXPECT_NEAR(std::hypot(direction.cosine, direction.sine), 1, 4e-16) << turns;
  }
}

}  // namespace
}  // namespace spillway::test

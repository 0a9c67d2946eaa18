#include "src/picture/line_layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace spillway::test {
namespace {

std::vector<int> strengths(const LineLayer& layer, std::uint32_t columns, std::uint32_t rows) {
  std::vector<int> all;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      all.push_back(layer.strength(column, row));
    }
  }
  return all;
}

TEST(LineLayer, ALineThroughPixelCentresCoversThemAndNoOthers) {
  LineLayer layer(10, 5);
  layer.draw({2.5, 2.5}, {7.5, 2.5}, 1);
  for (std::uint32_t column = 2; column <= 7; ++column) {
    EXPECT_GE(layer.strength(column, 2), 240) << column;
    EXPECT_EQ(layer.strength(column, 0), 0) << column;
    EXPECT_EQ(layer.strength(column, 4), 0) << column;
  }
  EXPECT_EQ(layer.strength(0, 2), 0);
  EXPECT_EQ(layer.strength(9, 2), 0);
}

TEST(LineLayer, NeitherDirectionNorOrderNorRepetitionMatters) {
  LineLayer one(40, 40);
  one.draw({1.2, 3.4}, {35.6, 27.8}, 0.8F);
  one.draw({30, 2}, {4, 39}, 0.5F);
  LineLayer other(40, 40);
  other.draw({4, 39}, {30, 2}, 0.5F);
  other.draw({35.6, 27.8}, {1.2, 3.4}, 0.8F);
  other.draw({1.2, 3.4}, {35.6, 27.8}, 0.8F);
  EXPECT_EQ(strengths(one, 40, 40), strengths(other, 40, 40));
}

TEST(LineLayer, LinesFromFarAwayCrossThePictureAndOthersDoNothing) {
  LineLayer layer(20, 20);
  layer.draw({-1e9, 10.5}, {1e9, 10.5}, 1);
  layer.draw({-1e9, -5}, {1e9, -5}, 1);
  layer.draw({50, -1e9}, {50, 1e9}, 1);
  layer.draw({3.5, 3.5}, {3.5, 3.5}, 1);
  for (std::uint32_t column = 0; column < 20; ++column) {
    EXPECT_GE(layer.strength(column, 10), 240) << column;
    EXPECT_EQ(layer.strength(column, 3), 0) << column;
  }
}

TEST(LineLayer, ADiagonalHasNoGapsAndAboutTheWidthOfAnyOther) {
  LineLayer diagonal(100, 100);
  diagonal.draw({10, 10}, {90, 90}, 1);
  double sum = 0;
  for (const int strength : strengths(diagonal, 100, 100)) sum += strength / 255.0;
  EXPECT_NEAR(sum / std::sqrt(2 * 80.0 * 80.0), 0.9, 0.15);
  for (std::uint32_t i = 11; i < 89; ++i) EXPECT_GE(diagonal.strength(i, i), 200) << i;
}

TEST(LineLayer, TransparentPixelsStayTransparent) {
  LineLayer layer(4, 1);
  layer.draw({0, 0.5}, {4, 0.5}, 1);
  Picture picture(4, 1);
  picture.set(1, 0, kWhite, 1);
  layer.cover(picture, kBlack, 1);
  EXPECT_EQ(picture.opacity(0, 0), 0);
  EXPECT_EQ(picture.opacity(1, 0), 255);
  EXPECT_LT(picture.colour(1, 0)[0], 0.1);
}

}  // namespace
}  // namespace spillway::test

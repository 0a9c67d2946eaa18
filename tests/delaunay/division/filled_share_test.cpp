#include "src/delaunay/division/filled_share.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace spillway::test {
namespace {

template <int D, typename Make>
double share_of(std::size_t count, const Make& make) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform;
  std::vector<Point<D>> points(count);
  Box<D> box;
  for (auto& p : points) {
    p = make([&] { return uniform(random); });
    box.expand(p);
  }
  return filled_share<D>(points, box);
}

TEST(FilledShare, OfEvenlySpreadPointsIsLarge) {
  EXPECT_NEAR(share_of<2>(512, [](auto u) { return Point<2>{u(), 1e6 + 1e-3 * u()}; }), 0.86, 0.06);
  EXPECT_NEAR(share_of<3>(1024, [](auto u) { return Point<3>{u(), u(), u()}; }), 0.86, 0.06);
}

TEST(FilledShare, OfCurvesAndSurfacesIsSmall) {
  const auto ellipse = [](auto u) {
    const double t = 6.28 * u();
    return Point<2>{std::cos(t), std::sin(t) / 3};
  };
  EXPECT_LT(share_of<2>(512, ellipse), 0.4);
  const auto cylinder = [](auto u) {
    const double t = 6.28 * u();
    return Point<3>{std::cos(t), std::sin(t), u()};
  };
  EXPECT_LT(share_of<3>(1024, cylinder), 0.6);
}

TEST(FilledShare, TakesPointsWithoutExtentAndOfTheLargestOne) {
  const std::vector<Point<2>> equal(100, Point<2>{1, 2});
  EXPECT_GT(filled_share<2>(equal, {{1, 2}, {1, 2}}), 0);
  const std::vector<Point<2>> far{{-1.7e308, 0}, {1.7e308, 1}};
  EXPECT_GT(filled_share<2>(far, {{-1.7e308, 0}, {1.7e308, 1}}), 0);
  EXPECT_EQ(filled_share<2>({}, {}), 0);
}

}  // namespace
}  // namespace spillway::test

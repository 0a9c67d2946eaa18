#include "src/geometry/constructions/half_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "src/geometry/predicates.h"
#include "tests/geometry/point_families.h"

namespace spillway::test {
namespace {

template <typename Dimension>
class HalfSpaceTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                    std::integral_constant<int, 4>, std::integral_constant<int, 5>,
                                    std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(HalfSpaceTest, Dimensions);

template <int D>
Box<D> box_of(const Point<D>& a, const Point<D>& b) {
  Box<D> box;
  box.expand(a);
  box.expand(b);
  return box;
}

// The facet x_0 = 0 through the origin, listed so that larger x_0 is beyond.
template <int D>
std::array<Point<D>, D> facet_beyond_zero() {
  std::array<Point<D>, D> facet{};
  for (int i = 1; i < D; ++i) facet[i][i] = 1;
  Point<D> beyond{};
  beyond[0] = 1;
  std::array<Point<D>, D + 1> simplex;
  std::copy(facet.begin(), facet.end(), simplex.begin());
  simplex[D] = beyond;
  if (orientation<D>(simplex) < 0) std::swap(facet[0], facet[1]);
  return facet;
}

TYPED_TEST(HalfSpaceTest, IsClosedAndExact) {
  constexpr int D = TypeParam::value;
  const auto facet = facet_beyond_zero<D>();
  Box<D> box;
  box.lo.fill(-5);
  box.hi.fill(5);
  EXPECT_TRUE(HalfSpace<D>(facet).meets(box));
  box.hi[0] = 0;
  EXPECT_TRUE(HalfSpace<D>(facet).meets(box));
  box.hi[0] = -std::numeric_limits<double>::denorm_min();
  EXPECT_FALSE(HalfSpace<D>(facet).meets(box));
  EXPECT_FALSE(HalfSpace<D>(facet).meets(Box<D>{}));
}

TYPED_TEST(HalfSpaceTest, OfADegenerateFacetMeetsEverything) {
  constexpr int D = TypeParam::value;
  Box<D> box;
  box.lo.fill(3);
  box.hi.fill(4);
  EXPECT_TRUE(HalfSpace<D>(std::array<Point<D>, D>{}).meets(box));
}

TYPED_TEST(HalfSpaceTest, MeetsABoxIfAnyOfItsPointsIsBeyond) {
  constexpr int D = TypeParam::value;
  Random random(27);
  int misses = 0;
  for (const auto& group : hard_groups<D>(Hard::kSmallLattice, 2000, 28)) {
    auto simplex = simplex_of<D>(group);
    std::array<Point<D>, D> facet;
    std::copy_n(simplex.begin(), D, facet.begin());
    const Box<D> box = box_of<D>(group[D], group[D + 1]);
    bool any = false;
    for (int sample = 0; sample < 20; ++sample) {
      for (int k = 0; k < D; ++k) {
        simplex[D][k] = static_cast<double>(random.integer(static_cast<std::int64_t>(box.lo[k]),
                                                           static_cast<std::int64_t>(box.hi[k])));
      }
      any = any || orientation<D>(simplex) >= 0;
    }
    misses += HalfSpace<D>(facet).meets(box) ? 0 : 1;
    if (any) {
      EXPECT_TRUE(HalfSpace<D>(facet).meets(box));
    }
  }
  EXPECT_GT(misses, 100);
}

}  // namespace
}  // namespace spillway::test

#include "src/geometry/constructions/circumsphere.h"

#include <gtest/gtest.h>

#include <limits>

#include "src/geometry/predicates.h"
#include "tests/geometry/exact_sphere.h"
#include "tests/geometry/point_families.h"

namespace spillway::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// That a ball is true to its word.
template <int D>
void expect_true_bounds(const std::array<Point<D>, D + 1>& simplex, const CertifiedBall<D>& ball) {
  ASSERT_NE(orientation<D>(simplex), 0);
  const ExactSphere<D> exact(simplex);
  EXPECT_LE(exact.squared_radius, Rational(ball.squared_radius));
  for (int k = 0; k < D; ++k) {
    const Rational rounded = Rational(ball.anchor[k]) + Rational(ball.centre[k]);
    EXPECT_LE(abs(exact.centre[k] - rounded), Rational(ball.error));
  }
}

template <int D>
Box<D> box_of(const Point<D>& a, const Point<D>& b) {
  Box<D> box;
  box.expand(a);
  box.expand(b);
  return box;
}

// A box that touches the rounded circumsphere of a ball from outside, up to the relative distance
// `slack`, at a face, an edge or a corner.
template <int D>
Box<D> touching_box(const CertifiedBall<D>& ball, double slack, Random& random) {
  std::array<double, D> direction;
  double length = 0;
  do {
    for (double& d : direction) d = random.integer(0, 2) == 0 ? 0 : random.uniform(-1, 1);
    length = std::sqrt(squared_length(direction));
  } while (length == 0);
  const double radius = std::sqrt(ball.squared_radius) * (1 + slack);
  Point<D> near;
  Point<D> far;
  for (int k = 0; k < D; ++k) {
    const double size = radius * random.uniform(0, 3);
    near[k] = ball.anchor[k] + (ball.centre[k] + direction[k] / length * radius);
    far[k] = direction[k] > 0 ? near[k] + size : near[k] - size;
    if (direction[k] == 0) near[k] += radius * random.uniform(0, 0.1);
  }
  return box_of<D>(near, far);
}

// A simplex with every edge between about 0.5 and 2 and no small angle.
template <int D>
std::array<Point<D>, D + 1> well_shaped(Random& random, double scale, double offset) {
  std::array<Point<D>, D + 1> simplex{};
  for (int k = 0; k < D; ++k) simplex[k + 1][k] = 1;
  for (auto& point : simplex) {
    for (double& c : point) c = (c + random.uniform(-0.1, 0.1)) * scale + offset;
  }
  return simplex;
}

template <typename Dimension>
class CertifiedBallTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                    std::integral_constant<int, 4>, std::integral_constant<int, 5>,
                                    std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(CertifiedBallTest, Dimensions);

TYPED_TEST(CertifiedBallTest, BoundsHoldAgainstRationalArithmetic) {
  constexpr int D = TypeParam::value;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    for (const auto& group : hard_groups<D>(family, 200, 21)) {
      const auto simplex = simplex_of<D>(group);
      const CertifiedBall<D> ball = certified_ball<D>(simplex);
      if (ball.error < kInfinity) expect_true_bounds<D>(simplex, ball);
    }
  }
}

TYPED_TEST(CertifiedBallTest, BoundsOfManyAtOnceHoldAgainstRationalArithmetic) {
  constexpr int D = TypeParam::value;
  constexpr std::size_t kSize = SimplexBatch<D>::kSize;
  std::size_t proofs = 0;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    const auto groups = hard_groups<D>(family, 4 * kSize, 22);
    for (std::size_t begin = 0; begin < groups.size(); begin += kSize) {
      SimplexBatch<D> batch;
      for (std::size_t s = 0; s < kSize; ++s) {
        batch.set(s, [&](int i) { return groups[begin + s][i]; });
      }
      BallBatch<D> balls;
      certify<D>(batch, balls);
      for (std::size_t s = 0; s < kSize; ++s) {
        if (balls.error[s] == kInfinity) continue;
        ++proofs;
        expect_true_bounds<D>(simplex_of<D>(groups[begin + s]), balls.at(s));
      }
    }
  }
  EXPECT_GT(proofs, 500U);
}

TYPED_TEST(CertifiedBallTest, ManyAtOnceMeetTheBoxesThatTheyMeetOneByOne) {
  constexpr int D = TypeParam::value;
  constexpr std::size_t kSize = SimplexBatch<D>::kSize;
  Random random(24);
  std::uint64_t all_met = 0;
  std::uint64_t all_missed = 0;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    const auto groups = hard_groups<D>(family, kSize, 25);
    SimplexBatch<D> batch;
    for (std::size_t s = 0; s < kSize; ++s) {
      batch.set(s, [&](int i) { return groups[s][i]; });
    }
    BallBatch<D> balls;
    certify<D>(batch, balls);
    std::vector<Box<D>> boxes = {Box<D>(), whole_space<D>()};
    for (std::size_t s = 0; s < kSize; ++s) {
      if (balls.certified(s)) boxes.push_back(touching_box<D>(balls.at(s), 1e-15, random));
      boxes.push_back(box_of<D>(groups[s][0], groups[kSize - 1 - s][1]));
      boxes.back().hi[0] = kInfinity;
    }
    for (const Box<D>& box : boxes) {
      std::uint64_t one_by_one = 0;
      for (std::size_t s = 0; s < kSize; ++s) {
        if (may_meet<D>(balls.at(s), box)) one_by_one |= std::uint64_t{1} << s;
      }
      for (const std::uint64_t asked : {~std::uint64_t{0}, std::uint64_t{0x8000000100F00002}}) {
        EXPECT_EQ(may_meet<D>(balls, box, asked), one_by_one & asked);
      }
      all_met |= one_by_one;
      all_missed |= ~one_by_one;
    }
  }
  EXPECT_EQ(all_met, ~std::uint64_t{0});
  EXPECT_EQ(all_missed, ~std::uint64_t{0});
}

TYPED_TEST(CertifiedBallTest, ManyAtOnceAreTightForWellShapedSimplices) {
  constexpr int D = TypeParam::value;
  Random random(23);
  SimplexBatch<D> batch{};
  BallBatch<D> balls;
  for (int trial = 0; trial < 300; ++trial) {
    const auto simplex = well_shaped<D>(random, random.uniform(0.5, 100), 5e6);
    batch.set(0, [&](int i) { return simplex[i]; });
    certify<D>(batch, balls);
    const CertifiedBall<D> ball = certified_ball<D>(simplex);
    EXPECT_LE(balls.error[0], 1e-9 * std::sqrt(ball.squared_radius));
    EXPECT_LE(balls.squared_radius[0], (1 + 1e-9) * ball.squared_radius);
    EXPECT_EQ(balls.error[1], kInfinity);  // a point
  }
}

TYPED_TEST(CertifiedBallTest, FalseIsAProofForTouchingBoxes) {
  constexpr int D = TypeParam::value;
  Random random(22);
  std::size_t proofs = 0;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    for (const auto& group : hard_groups<D>(family, 150, 23)) {
      const auto simplex = simplex_of<D>(group);
      const CertifiedBall<D> ball = certified_ball<D>(simplex);
      if (ball.error == kInfinity) continue;
      const ExactSphere<D> exact(simplex);
      for (const double slack : {-1e-14, -1e-16, 0.0, 1e-16, 1e-15, 3e-15, 1e-14, 1e-13, 1e-11}) {
        const Box<D> box = touching_box<D>(ball, slack, random);
        if (may_meet<D>(ball, box)) continue;
        ++proofs;
        EXPECT_FALSE(exact.meets(box)) << "slack " << slack;
      }
    }
  }
  EXPECT_GT(proofs, 500U);
}

TYPED_TEST(CertifiedBallTest, ItsOwnVerticesMayMeet) {
  constexpr int D = TypeParam::value;
  for (const auto& group : hard_groups<D>(Hard::kCospherical, 500, 24)) {
    const auto simplex = simplex_of<D>(group);
    const CertifiedBall<D> ball = certified_ball<D>(simplex);
    for (const auto& vertex : simplex) EXPECT_TRUE(may_meet<D>(ball, box_of<D>(vertex, vertex)));
  }
}

TYPED_TEST(CertifiedBallTest, IsTightForWellShapedSimplices) {
  constexpr int D = TypeParam::value;
  Random random(25);
  for (const double offset : {0.0, 1.0, 5e6}) {
    for (int trial = 0; trial < 500; ++trial) {
      const double scale = random.uniform(0.5, 100);
      const auto simplex = well_shaped<D>(random, scale, offset);
      const CertifiedBall<D> ball = certified_ball<D>(simplex);
      const double radius = std::sqrt(ball.squared_radius);
      EXPECT_LT(ball.error, 1e-13 * radius);
      const ExactSphere<D> exact(simplex);
      EXPECT_LT(static_cast<double>(Rational(ball.squared_radius) / exact.squared_radius - 1),
                1e-12);
      // Boxes around an offset are rounded to its unit in the last place.
      const double slack = 1e-12 + offset * 0x1p-50 / radius;
      EXPECT_FALSE(may_meet<D>(ball, touching_box<D>(ball, slack, random)));
    }
  }
}

TYPED_TEST(CertifiedBallTest, DegenerateAndExtremeSimplicesMayMeetAnything) {
  constexpr int D = TypeParam::value;
  Point<D> far_away;
  far_away.fill(1e308);
  const Box<D> box = box_of<D>(far_away, far_away);
  std::array<Point<D>, D + 1> flat{};
  for (int i = 0; i <= D; ++i) flat[i].fill(i);
  EXPECT_TRUE(may_meet<D>(certified_ball<D>(flat), box));
  EXPECT_TRUE(may_meet<D>(certified_ball<D>({}), box));
  for (const double extreme : {1e-320, 1e-200, 1e200, 1e308, kInfinity, kNan}) {
    std::array<Point<D>, D + 1> simplex{};
    for (int k = 0; k < D; ++k) simplex[k + 1][k] = extreme;
    EXPECT_TRUE(may_meet<D>(certified_ball<D>(simplex), box)) << extreme;
  }
}

TYPED_TEST(CertifiedBallTest, InfiniteAndEmptyBoxesAreUnderstood) {
  constexpr int D = TypeParam::value;
  Random random(26);
  const CertifiedBall<D> ball = certified_ball<D>(well_shaped<D>(random, 1, 0));
  EXPECT_FALSE(may_meet<D>(ball, Box<D>{}));
  Box<D> half_space;
  half_space.lo.fill(-kInfinity);
  half_space.hi.fill(kInfinity);
  EXPECT_TRUE(may_meet<D>(ball, half_space));
  half_space.lo[0] = 10;
  EXPECT_FALSE(may_meet<D>(ball, half_space));
  half_space.lo[0] = -1;
  EXPECT_TRUE(may_meet<D>(ball, half_space));
}

// Boxes that a simplex's circumsphere is in, or sticks out of, by little, by much and by a side
// that is infinite; and the largest.
template <int D>
std::vector<Box<D>> boxes_around(const CertifiedBall<D>& ball, Random& random) {
  std::vector<Box<D>> boxes;
  const double radius = ball.error == kInfinity ? 1 : std::sqrt(ball.squared_radius);
  for (const double room : {-1e-3, -1e-15, 0.0, 1e-15, 1e-12, 1e-4, 6e-4, 1e-2, 1.0, 1e6}) {
    Box<D> box;
    for (int k = 0; k < D; ++k) {
      const double centre = ball.anchor[k] + (ball.error == kInfinity ? 0 : ball.centre[k]);
      box.lo[k] = centre - radius * (1 + random.uniform(0, 3));
      box.hi[k] = centre + radius * (1 + random.uniform(0, 3));
    }
    const auto axis = random.integer(0, D - 1);
    const double centre = ball.anchor[axis] + (ball.error == kInfinity ? 0 : ball.centre[axis]);
    box.lo[axis] = centre - radius * (1 + room);
    if (random.integer(0, 2) == 0) box.hi[axis] = kInfinity;
    boxes.push_back(box);
  }
  Box<D> everything;
  everything.lo.fill(-kInfinity);
  everything.hi.fill(kInfinity);
  boxes.push_back(everything);
  boxes.push_back({});
  return boxes;
}

TYPED_TEST(CertifiedBallTest, WellInsideIsProvedByRationalArithmetic) {
  constexpr int D = TypeParam::value;
  Random random(31);
  std::size_t proofs = 0;
  for (const Hard family : kAllHard) {
    SCOPED_TRACE(name_of(family));
    for (const auto& group : hard_groups<D>(family, 60, 32)) {
      const auto simplex = simplex_of<D>(group);
      SimplexBatch<D> batch{};
      batch.set(7, [&](int i) { return simplex[i]; });
      for (const Box<D>& box : boxes_around<D>(certified_ball<D>(simplex), random)) {
        if (!well_inside<D>(batch, box)[7]) continue;
        ++proofs;
        EXPECT_TRUE(ExactSphere<D>(simplex).inside(box));
      }
    }
  }
  EXPECT_GT(proofs, 100U);
}

TYPED_TEST(CertifiedBallTest, WellShapedSimplicesWithALittleRoomAreWellInside) {
  constexpr int D = TypeParam::value;
  Random random(33);
  for (const double offset : {0.0, 5e6}) {
    for (int trial = 0; trial < 300; ++trial) {
      const auto simplex = well_shaped<D>(random, random.uniform(0.5, 100), offset);
      const CertifiedBall<D> ball = certified_ball<D>(simplex);
      Box<D> box;
      for (int k = 0; k < D; ++k) {
        const double reach = 1.001 * std::sqrt(ball.squared_radius);
        box.lo[k] = ball.anchor[k] + (ball.centre[k] - reach);
        box.hi[k] = ball.anchor[k] + (ball.centre[k] + reach);
      }
      SimplexBatch<D> batch{};
      batch.set(0, [&](int i) { return simplex[i]; });
      EXPECT_TRUE(well_inside<D>(batch, box)[0]);
      EXPECT_FALSE(well_inside<D>(batch, box)[1]);  // a point
    }
  }
}

TYPED_TEST(CertifiedBallTest, NothingIsKnownOfWhatIsNotFinite) {
  constexpr int D = TypeParam::value;
  Box<D> everything;
  everything.lo.fill(-kInfinity);
  everything.hi.fill(kInfinity);
  for (const double strange : {kInfinity, -kInfinity, kNan, 1e308}) {
    for (int i = 0; i <= D; ++i) {
      for (int k = 0; k < D; ++k) {
        std::array<Point<D>, D + 1> simplex{};
        for (int c = 0; c < D; ++c) simplex[c + 1][c] = 1;
        simplex[i][k] = strange;
        SimplexBatch<D> batch{};
        batch.set(0, [&](int c) { return simplex[c]; });
        EXPECT_FALSE(well_inside<D>(batch, everything)[0]) << strange << ' ' << i << ' ' << k;
        BallBatch<D> balls;
        certify<D>(batch, balls);
        EXPECT_EQ(balls.error[0], kInfinity) << strange << ' ' << i << ' ' << k;
      }
    }
  }
}

}  // namespace
}  // namespace spillway::test

#include "src/delaunay/division/cut_judgement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "src/delaunay/common/schedule.h"
#include "src/delaunay/division/divide.h"

namespace spillway::test {
namespace {

/// Points on an ellipse whose half-axes are 3 and `height`.
std::vector<Point<2>> ellipse(std::size_t count, double height) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> angle(0, 6.283);
  std::vector<Point<2>> points(count);
  for (auto& p : points) {
    const double t = angle(random);
    p = {3 * std::cos(t), height * std::sin(t)};
  }
  return points;
}

TEST(CutJudgement, AnEllipseIsCutAcrossItsLongAxis) {
  const CutJudgement<2> judgement(ellipse(500, 2));
  ASSERT_TRUE(judgement.known());
  const JudgedCut best = judgement.best_cut(1, 250, 0);
  EXPECT_EQ(best.axis, 0);
  EXPECT_EQ(best.below, 250U);
  EXPECT_LT(best.share, 0.05);
}

TEST(CutJudgement, EvenlySpreadPointsAreCutInTheMiddleOfThePreferredAxis) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> uniform;
  std::vector<Point<3>> points(1000);
  for (auto& p : points) p = {uniform(random), uniform(random), uniform(random)};
  const CutJudgement<3> judgement(points);
  for (int axis = 0; axis < 3; ++axis) {
    const JudgedCut best = judgement.best_cut(axis, 500, 50);
    EXPECT_EQ(best.axis, axis);
    EXPECT_EQ(best.below, 500U);
  }
}

TEST(CutJudgement, TwoClustersAreCutBetweenThem) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform;
  std::vector<Point<2>> points;  // 250 and 330 points, and a row of 20 between
  for (int i = 0; i < 250; ++i) points.push_back({uniform(random), uniform(random)});
  for (int i = 0; i < 330; ++i) points.push_back({5 + uniform(random), uniform(random)});
  for (int i = 0; i < 20; ++i) points.push_back({1.1 + 0.19 * i, 0.5 + 0.01 * uniform(random)});
  const JudgedCut best = CutJudgement<2>(points).best_cut(0, 300, 75);
  EXPECT_EQ(best.axis, 0);
  EXPECT_GE(best.below, 250U);
  EXPECT_LE(best.below, 271U);
}

TEST(CutJudgement, NothingIsKnownOfALine) {
  std::vector<Point<2>> points;
  for (int i = 0; i < 50; ++i) points.push_back({double(i), 2.0 * i});
  EXPECT_FALSE(CutJudgement<2>(points).known());
}

TEST(CutJudgement, NoCutSeparatesEqualCoordinates) {
  std::vector<Point<2>> points;
  for (int i = 0; i < 100; ++i) points.push_back({double(i / 50), double(i)});
  const JudgedCut best = CutJudgement<2>(points).best_cut(0, 40, 0);
  EXPECT_EQ(best.axis, 1);
}

/// One triangle across the cut of each axis.
TEST(CutJudgement, PointsOfGivenSimplicesCountByTheirWeights) {
  const std::vector<Point<2>> points = {{0, 0},   {10, 0.1}, {11, 0.2},
                                        {1, 0.3}, {1.5, 10}, {0.5, 11}};
  const std::vector<std::array<VertexId, 3>> simplices = {{0, 1, 2}, {3, 4, 5}};
  const std::vector<double> equal(6, 2.0);
  EXPECT_EQ(CutJudgement<2>(points, equal, simplices).best_cut(1, 4, 0).axis, 1);
  const std::vector<double> weights = {1, 1, 1, 5, 5, 5};
  const JudgedCut best = CutJudgement<2>(points, weights, simplices).best_cut(1, 4, 0);
  EXPECT_EQ(best.axis, 0);
  EXPECT_DOUBLE_EQ(best.share, 3.0 / 18);
  EXPECT_FALSE(CutJudgement<2>(points, weights, {}).known());
}

/// Whether divide() leaves the points in one part if it may.
bool stays_whole(std::vector<Point<2>> points) {
  std::vector<VertexId> index(points.size());
  for (VertexId v = 0; v < index.size(); ++v) index[v] = v;
  const DivideOptions options{
      .leaf_points = 1000, .smallest_judged = 1000, .largest_undivided = 100'000};
  return divide<2>(points, index, options).leaf();
}

TEST(CutJudgement, ParallelLinesAreNotDivided) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  std::vector<Point<2>> points(10'000);
  for (auto& p : points) {
    const double t = uniform(random);
    p = random() % 2 == 0 ? Point<2>{t, 0.1 + 0.9 * t} : Point<2>{1 - t, t};
  }
  EXPECT_TRUE(stays_whole(points));
  EXPECT_FALSE(stays_whole(ellipse(10'000, 2)));
}

}  // namespace
}  // namespace spillway::test

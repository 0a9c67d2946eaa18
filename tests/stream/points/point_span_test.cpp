// What points span, told while they come: by many threads, in any order, exactly.

#include "stream/points/point_span.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "src/error.h"
#include "src/parallel/parallel.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

template <int D>
std::string refusal(const PointSpan<D>& span, std::uint64_t points) {
  try {
    refuse_flat_points(span, points);
  } catch (const Failure& error) {
    return error.what();
  }
  return "";
}

/// Points on a line, or in a plane, of an oblique direction, shuffled.
std::vector<LatticePoint> flat_points(int dimension, int count) {
  std::vector<LatticePoint> points;
  for (int i = 0; i < count; ++i) {
    const double s = i;
    const double t = dimension == 2 ? (i * 7919) % 101 : 0;
    points.push_back({3 * s + t, 7 * s - 2 * t, 1e6 - 11 * s + 5 * t});
  }
  std::shuffle(points.begin(), points.end(), std::mt19937(1));
  return points;
}

TEST(PointSpan, OfALineAndAPlaneIsToldAndOnePointBesideChangesIt) {
  std::vector<LatticePoint> line = flat_points(1, 5000);
  PointSpan<2> on_line;
  on_line.add(PointsView{line});
  EXPECT_THAT(refusal(on_line, 5000), HasSubstr("all 5000 points lie on one line"));
  PointSpan<3> line_in_space;
  line_in_space.add(PointsView{line});
  EXPECT_THAT(refusal(line_in_space, 5000), HasSubstr("one line: there is no tetrahedron"));
  PointSpan<3> plane;
  plane.add(PointsView{flat_points(2, 5000)});
  EXPECT_THAT(refusal(plane, 5000), HasSubstr("in one plane"));
  const std::vector<LatticePoint> beside = {{0, 1e-9, 0}};
  on_line.add(PointsView{beside});
  plane.add(PointsView{beside});
  EXPECT_TRUE(on_line.full());
  EXPECT_TRUE(plane.full());
  EXPECT_EQ(refusal(plane, 5001), "");
}

TEST(PointSpan, OfFewDistinctPointsNamesTheirNumber) {
  const std::vector<LatticePoint> two = {{1, 2, 3}, {4, 5, 6}, {1, 2, 3}, {4, 5, 6}};
  PointSpan<2> span;
  span.add(PointsView{std::span(two).first(1)});
  EXPECT_THAT(refusal(span, 1), HasSubstr("only 1 distinct point:"));
  span.add(PointsView{two});
  EXPECT_THAT(refusal(span, 4), HasSubstr("only 2 distinct points"));
  const std::vector<LatticePoint> third = {{7, 8, 0}};
  span.add(PointsView{third});
  EXPECT_THAT(refusal(span, 5), HasSubstr("all 5 points lie on one line"));
}

TEST(PointSpan, DoesNotDependOnHowManyThreadsAddWhatFirst) {
  const std::vector<LatticePoint> points = flat_points(2, 60000);
  for (const unsigned threads : {1U, 2U, 7U}) {
    PointSpan<3> span;
    with_threads(threads, [&] {
      parallel_for(points.size(), 500, [&](std::size_t, std::size_t begin, std::size_t end) {
        span.add(PointsView{std::span(points).subspan(begin, end - begin)});
      });
    });
    EXPECT_THAT(refusal(span, points.size()), HasSubstr("in one plane"));
  }
}

TEST(PointSpan, OfPartsIsThatOfTheWhole) {
  const std::vector<LatticePoint> points = flat_points(2, 3000);
  PointSpan<3> all;
  for (std::size_t begin = 0; begin < points.size(); begin += 7) {
    PointSpan<3> part;
    part.add(PointsView{
        std::span(points).subspan(begin, std::min<std::size_t>(7, points.size() - begin))});
    all.add(part.facts());
  }
  EXPECT_THAT(refusal(all, 3000), HasSubstr("in one plane"));
  PointSpan<3> other;
  const std::vector<LatticePoint> beside = {{0.5, 0.25, 0}};
  other.add(PointsView{beside});
  all.add(other.facts());
  EXPECT_TRUE(all.full());
}

}  // namespace
}  // namespace spillway::test

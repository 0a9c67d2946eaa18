// Errors, interruptions, progress, and programs that do several things at once.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/delaunay.h>
#include <spillway/version.h>

#include <cfenv>
#include <limits>
#include <thread>

#include "src/library/construction.h"
#include "tests/library/point_sets.h"
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

template <typename Dimension>
class InMemoryFault : public ::testing::Test {};
TYPED_TEST_SUITE(InMemoryFault, Dimensions, DimensionNames);

/// The code that triangulating throws; the text has to hold `text`.
template <int D, class Index = std::int32_t>
ErrorCode code_of(const PointView<D>& points, const std::string& text,
                  const DelaunayOptions& options = {}) {
  try {
    const Delaunay<D, Index> mesh(points, options);
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(text));
    return error.code();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

TYPED_TEST(InMemoryFault, PointsThatAreNotFinite) {
  constexpr int D = TypeParam::value;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    Points<D> points = random_points<D>(60'000, 1);
    points[59'000][0] = bad;
    points[41'234][D - 1] = bad;
    EXPECT_EQ(code_of<D>(points, "point 41234 "), ErrorCode::kInvalidArgument);
  }
}

TYPED_TEST(InMemoryFault, PointsThatSpanNothing) {
  constexpr int D = TypeParam::value;
  const std::string cell = D == 2 ? "triangle" : "tetrahedron";
  EXPECT_EQ(code_of<D>(PointView<D>(), "no points"), ErrorCode::kDegenerateInput);
  EXPECT_EQ(code_of<D>(Points<D>(1), "at one place"), ErrorCode::kDegenerateInput);
  EXPECT_EQ(code_of<D>(Points<D>(1000), cell), ErrorCode::kDegenerateInput);
  Points<D> line(100);
  for (int i = 0; i < 100; ++i) line[i].fill(i * i);
  EXPECT_EQ(code_of<D>(line, "(100) lie on one line"), ErrorCode::kDegenerateInput);
  if constexpr (D == 3) {
    Points<D> plane = random_points<D>(100, 2);
    for (auto& p : plane) p[2] = 7;
    EXPECT_EQ(code_of<D>(plane, "on one plane"), ErrorCode::kDegenerateInput);
  }
}

TYPED_TEST(InMemoryFault, MorePointsThanNumbers) {
  constexpr int D = TypeParam::value;
  // One point in memory, seen often: nothing of that size may be asked for before the check.
  const Point<D> point{};
  std::array<const double*, D> axes;
  for (int k = 0; k < D; ++k) axes[k] = &point[k];
  const PointView<D> many(axes, std::size_t{1} << 31, 0);
  EXPECT_EQ(code_of<D>(many, "2147483648 points: at most 2147483647"), ErrorCode::kTooLarge);
  const PointView<D> more(axes, std::size_t{1} << 33, 0);
  EXPECT_EQ((code_of<D, std::int64_t>(more, "8589934592 points")), ErrorCode::kTooLarge);
}

TEST(Numbers, AsManyAsThereAreAreEnough) {
  require_numbers(5, 5, "cells");
  EXPECT_THROW(require_numbers(6, 5, "cells"), Error);
}

TYPED_TEST(InMemoryFault, ArgumentsOfNoUse) {
  constexpr int D = TypeParam::value;
  const Points<D> points = random_points<D>(10, 1);
  EXPECT_EQ(code_of<D>(points, "5000 threads", {.threads = 5000}), ErrorCode::kInvalidArgument);
  const Delaunay<D> mesh(points);
  EXPECT_THROW(static_cast<void>(mesh.circumcentre(-1)), Error);
  EXPECT_THROW(static_cast<void>(mesh.circumcentre(static_cast<std::int32_t>(mesh.cell_count()))),
               Error);
  const std::vector<double> values(9);
  EXPECT_THROW(static_cast<void>(mesh.interpolate(values, points)), Error);
}

TYPED_TEST(InMemoryFault, StopBeforeTheBeginning) {
  constexpr int D = TypeParam::value;
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(code_of<D>(random_points<D>(10, 1), "interrupted", {.stop = stop.get_token()}),
            ErrorCode::kInterrupted);
}

TYPED_TEST(InMemoryFault, StopInTheMidstOfWork) {
  constexpr int D = TypeParam::value;
  const Points<D> points = random_points<D>(D == 2 ? 300'000 : 140'000, 3);
  for (const unsigned threads : {1U, 2U}) {
    std::stop_source stop;
    std::size_t told = 0;
    EXPECT_EQ(code_of<D>(points, "interrupted",
                         {.threads = threads,
                          .progress =
                              [&](std::size_t done, std::size_t) {
                                told = done;
                                stop.request_stop();
                              },
                          .stop = stop.get_token()}),
              ErrorCode::kInterrupted);
    EXPECT_GT(told, 0);
  }
}

TYPED_TEST(InMemoryFault, ProgressAscendsToTheTotal) {
  constexpr int D = TypeParam::value;
  const Points<D> points = random_points<D>(D == 2 ? 300'000 : 140'000, 3);
  std::vector<std::size_t> told;
  const Delaunay<D> mesh(points,
                         {.threads = 2, .progress = [&](std::size_t done, std::size_t total) {
                            EXPECT_EQ(total, points.size());
                            told.push_back(done);
                          }});
  EXPECT_GT(told.size(), 1);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), points.size());
}

TYPED_TEST(InMemoryFault, WhatProgressThrowsReachesTheCaller) {
  constexpr int D = TypeParam::value;
  const auto fail = [](std::size_t, std::size_t) { throw std::out_of_range("enough"); };
  EXPECT_THROW(Delaunay<D>(random_points<D>(100'000, 3), {.threads = 2, .progress = fail}),
               std::out_of_range);
}

TYPED_TEST(InMemoryFault, TwoMeshesBesideEachOther) {
  constexpr int D = TypeParam::value;
  const Points<D> a = random_points<D>(80'000, 4), b = random_points<D>(90'000, 5);
  const auto hash_of = [](const Points<D>& points, unsigned threads) {
    const Delaunay<D> mesh(points, {.threads = threads});
    EXPECT_EQ(mesh.nearest_vertex(points).back(), points.size() - 1);
    return mesh.canonical_hash();
  };
  const std::uint64_t expected_a = hash_of(a, 1), expected_b = hash_of(b, 2);
  for (int round = 0; round < 3; ++round) {
    std::uint64_t found_a = 0, found_b = 0;
    std::jthread other([&] { found_a = hash_of(a, 1 + round); });
    found_b = hash_of(b, 3);
    other.join();
    EXPECT_EQ(found_a, expected_a);
    EXPECT_EQ(found_b, expected_b);
  }
}

TYPED_TEST(InMemoryFault, OneMeshAskedByManyThreads) {
  constexpr int D = TypeParam::value;
  const Points<D> points = random_points<D>(5'000, 6);
  const Delaunay<D> mesh(points);
  const auto expected = mesh.nearest_vertex(points);
  std::vector<std::jthread> threads;
  std::array<bool, 4> right{};
  for (std::size_t t = 0; t < right.size(); ++t) {
    threads.emplace_back([&, t] { right[t] = mesh.nearest_vertex(points) == expected; });
  }
  threads.clear();
  EXPECT_THAT(right, ::testing::Each(true));
}

#if defined(__x86_64__)
TYPED_TEST(InMemoryFault, ProgramsMayRoundAndFlushAsTheyLike) {
  constexpr int D = TypeParam::value;
  Points<D> points = lattice_points<D>(60 / D / D, 7);
  const Points<D> large = random_points<D>(D == 2 ? 70'000 : 140'000, 8);  // several threads
  for (auto& p : points) {
    for (double& c : p) c *= 0x1p-1074;
  }
  const Delaunay<D> tiny(points), wide(large);
  const unsigned before = _mm_getcsr();
  const unsigned odd = before | 0x8040U | 0x4000U;  // subnormals to zero, rounds upwards
  _mm_setcsr(odd);
  const Delaunay<D> same_tiny(points), same_wide(large, {.threads = 2});
  const auto found = same_tiny.nearest_vertex(points);
  const unsigned after = _mm_getcsr();
  _mm_setcsr(before);
  EXPECT_EQ(after & 0xFFC0U, odd & 0xFFC0U);
  EXPECT_EQ(same_tiny.canonical_hash(), tiny.canonical_hash());
  EXPECT_EQ(same_wide.canonical_hash(), wide.canonical_hash());
  EXPECT_EQ(found, tiny.nearest_vertex(points));
}
#endif

TEST(Errors, CodesHaveNames) {
  EXPECT_STREQ(to_string(ErrorCode::kInvalidArgument), "invalid argument");
  EXPECT_STREQ(to_string(ErrorCode::kDegenerateInput), "degenerate input");
  EXPECT_STREQ(to_string(ErrorCode::kTooLarge), "too large");
  EXPECT_STREQ(to_string(ErrorCode::kInterrupted), "interrupted");
  EXPECT_EQ(version(), SPILLWAY_VERSION_TEXT);
}

}  // namespace
}  // namespace spillway::test

// One point a cell, compared with a map of all cells: for every choice, any order of the points,
// and so little memory that cells go to the disk, several times over.

#include "stream/source/thinning/thinning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <tuple>

#include "src/error.h"

namespace spillway {

/// For the names of tests.
static void PrintTo(ThinChoice choice, std::ostream* out) {
  constexpr std::array kNames = {"First", "Lowest", "Highest", "Center"};
  *out << kNames.at(static_cast<std::size_t>(choice));
}

}  // namespace spillway

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

struct Indexed {
  LatticePoint point;
  std::uint64_t index;

  bool operator==(const Indexed&) const = default;
  bool operator<(const Indexed& other) const { return index < other.index; }
};
using Cloud = std::vector<Indexed>;

Cloud cloud(std::size_t count, double extent) {
  std::mt19937_64 random(5);
  Cloud points(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (double& x : points[i].point) {
      x = std::floor(extent * static_cast<double>(random() % 100'000) / 1e5 * 8) / 8;
    }
    points[i].point[0] -= extent / 2;  // on both sides of 0
    points[i].index = i;
  }
  return points;
}

/// The specification, word by word.
Cloud expected(const Cloud& points, const ThinningOptions& options) {
  const bool columns =
      options.choice == ThinChoice::kLowest || options.choice == ThinChoice::kHighest;
  const int dimension = columns ? 2 : options.dimension;
  struct Best {
    std::size_t met;
    std::tuple<double, std::uint64_t> rank;
    Indexed point;
  };
  std::map<std::array<double, 3>, Best> best;
  for (const Indexed& p : points) {
    const WorldPoint world = in_world(options.lattice, p.point);
    std::array<double, 3> cell{};
    double away = 0;
    for (int k = 0; k < dimension; ++k) {
      cell[k] = std::floor(world[k] / options.cell);
      away += std::pow(world[k] - (cell[k] + 0.5) * options.cell, 2);
    }
    const double rank = options.choice == ThinChoice::kLowest    ? world[2]
                        : options.choice == ThinChoice::kHighest ? -world[2]
                        : options.choice == ThinChoice::kCenter  ? away
                                                                 : 0;
    const Best here{best.size(), {rank, p.index}, p};
    const auto [found, is_new] = best.try_emplace(cell, here);
    if (!is_new && here.rank < found->second.rank) {
      found->second.rank = here.rank;
      found->second.point = p;
    }
  }
  Cloud kept(best.size());
  for (const auto& [cell, found] : best) kept[found.met] = found.point;
  return kept;
}

/// In the order in which they come.
Cloud thinned(const Cloud& points, const ThinningOptions& options,
              std::uint64_t* spilled = nullptr) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  Thinning thinning(options, *scratch);
  PointBlock block;
  for (const Indexed& p : points) {
    block.points.push_back(p.point);
    block.index.push_back(p.index);
    if (block.size() == 1000) {
      thinning.add(block);
      block.clear();
    }
  }
  thinning.add(block);
  Cloud kept;
  while (thinning.next(block)) {
    for (std::size_t i = 0; i < block.size(); ++i)
      kept.push_back({block.points[i], block.index[i]});
  }
  EXPECT_FALSE(thinning.next(block));
  EXPECT_EQ(kept.size() + thinning.dropped(), points.size());
  if (spilled != nullptr) *spilled = scratch->bytes_written();
  return kept;
}

class EveryChoice : public ::testing::TestWithParam<ThinChoice> {};

TEST_P(EveryChoice, KeepsTheBestPointOfEachCellInTheOrderOfTheCellsWhateverTheMemory) {
  for (const int dimension : {2, 3}) {
    ThinningOptions options{.cell = 0.75, .choice = GetParam(), .dimension = dimension};
    const Cloud points = cloud(60'000, 100);
    const Cloud truth = expected(points, options);
    for (const unsigned kibibytes : {65536U, 2560U, 2176U, 0U}) {
      options.memory = std::uint64_t{kibibytes} << 10;
      std::uint64_t spilled = 0;
      EXPECT_EQ(thinned(points, options, &spilled), truth) << kibibytes;
      EXPECT_EQ(spilled == 0, kibibytes == 65536) << kibibytes;
    }
  }
}

TEST_P(EveryChoice, KeepsTheBestPointOfEachCellWhateverTheOrder) {
  ThinningOptions options{.cell = 0.75, .choice = GetParam()};
  Cloud points = cloud(60'000, 100);
  Cloud truth = expected(points, options);
  std::sort(truth.begin(), truth.end());
  std::shuffle(points.begin(), points.end(), std::mt19937(1));
  for (const unsigned mebibytes : {64U, 0U}) {
    options.memory = std::uint64_t{mebibytes} << 20;
    Cloud kept = thinned(points, options);
    std::sort(kept.begin(), kept.end());
    EXPECT_EQ(kept, truth);
  }
}

INSTANTIATE_TEST_SUITE_P(Choices, EveryChoice,
                         ::testing::Values(ThinChoice::kFirst, ThinChoice::kLowest,
                                           ThinChoice::kHighest, ThinChoice::kCenter),
                         ::testing::PrintToStringParamName());

TEST(Thinning, CellsAreThoseOfOutputCoordinates) {
  ThinningOptions options{.cell = 2, .choice = ThinChoice::kCenter, .dimension = 3};
  options.lattice = IntegerLattice{{0.25, 0.25, 0.25}, {1000.5, -3, 0}};
  const Cloud points = cloud(20'000, 100);
  EXPECT_EQ(thinned(points, options), expected(points, options));
}

TEST(Thinning, WhatIsKeptComesInTheSameBlocksFromMemoryAndFromTheDisk) {
  const Cloud points = cloud(200'000, 2000);
  std::vector<std::vector<std::size_t>> sizes;
  for (const std::uint64_t memory : {std::uint64_t{64} << 20, std::uint64_t{0}}) {
    const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
    Thinning thinning({.cell = 1, .memory = memory}, *scratch);
    PointBlock block;
    for (const Indexed& p : points) {
      block.points.push_back(p.point);
      block.index.push_back(p.index);
    }
    thinning.add(block);
    std::vector<std::size_t>& of_blocks = sizes.emplace_back();
    while (thinning.next(block)) of_blocks.push_back(block.size());
  }
  EXPECT_GT(sizes[0].size(), 1U);
  EXPECT_EQ(sizes[0], sizes[1]);
}

TEST(Thinning, TellsHowManyOfThePointsPutAsideAreDone) {
  constexpr std::uint64_t kPoints = 60'000;
  std::uint64_t most = 0;
  std::uint64_t of = 0;
  std::uint64_t ended = 0;
  int begun = 0;
  // Every point has a cell of its own, and 1024 cells have room: files are put aside again.
  ThinningOptions options{.cell = 0.5, .choice = ThinChoice::kFirst};
  options.progress = {.begin = [&] { ++begun; },
                      .update =
                          [&](std::uint64_t done, std::uint64_t points) {
                            EXPECT_GE(done, most);
                            EXPECT_LE(done, points);
                            most = done;
                            of = points;
                          },
                      .end = [&](std::uint64_t points) { ended = points; }};
  Cloud points;
  for (std::uint64_t i = 0; i < kPoints; ++i) {
    points.push_back({{static_cast<double>(i), 0, 0}, i});
  }
  EXPECT_EQ(thinned(points, options), points);
  EXPECT_EQ(begun, 1);
  EXPECT_EQ(most, kPoints - 1024);
  EXPECT_EQ(of, kPoints - 1024);
  EXPECT_EQ(ended, kPoints - 1024);
}

TEST(Thinning, AttributesComeThrough) {
  for (const std::uint64_t memory : {std::uint64_t{64} << 20, std::uint64_t{0}}) {
    const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
    Thinning thinning({.cell = 1, .memory = memory}, *scratch);
    thinning.carry(AttributeLayout({{.name = "a", .type = NumberType::kUint32}}));
    PointBlock block;
    block.attributes.resize(5000 * sizeof(std::uint32_t));
    for (std::uint64_t i = 0; i < 5000; ++i) {
      block.points.push_back({1.0 * static_cast<double>(i), 0, 0});
      block.index.push_back(i);
      store(&block.attributes[i * sizeof(std::uint32_t)], static_cast<std::uint32_t>(7 * i));
    }
    thinning.add(block);
    std::size_t kept = 0;
    while (thinning.next(block)) {
      ASSERT_EQ(block.attributes.size(), block.size() * sizeof(std::uint32_t));
      kept += block.size();
      for (std::size_t i = 0; i < block.size(); ++i) {
        ASSERT_EQ(load<std::uint32_t>(&block.attributes[i * sizeof(std::uint32_t)]),
                  7 * block.index[i]);
      }
    }
    EXPECT_EQ(kept, 5000U);
  }
}

TEST(Thinning, CellsThatCannotBeCountedAreRefused) {
  try {
    thinned({{{1e6, 0, 0}, 0}}, {.cell = 1e-12});
    FAIL();
  } catch (const Failure& error) {
    EXPECT_THAT(error.what(), HasSubstr("cells of 1e-12 are too small"));
  }
}

TEST(Thinning, OfNothingIsNothing) { EXPECT_EQ(thinned({}, {.cell = 1}), Cloud{}); }

}  // namespace
}  // namespace spillway::test

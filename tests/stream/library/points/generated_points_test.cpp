// Generated points, as programs read them and as the pipeline takes them.

#include "stream/library/points/generated_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "stream/library/points/public_points.h"
#include "tests/error_facts.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;

/// What a run takes of the points, in output coordinates, and in blocks of which size.
struct Taken {
  std::vector<Point<3>> points{};
  std::vector<std::uint64_t> index{};
  std::vector<std::size_t> sizes{};
};

Taken taken_from(PointStream& stream) {
  Taken taken;
  SourcePiece piece;
  PointBlock block;
  while (stream.fetch(piece)) {
    stream.decode(piece, block);
    const auto points = public_points(stream.lattice(), block.points);
    taken.points.insert(taken.points.end(), points.begin(), points.end());
    taken.index.insert(taken.index.end(), block.index.begin(), block.index.end());
    taken.sizes.push_back(block.size());
  }
  return taken;
}

std::vector<Point<3>> all_of(PointSource& source) {
  std::vector<Point<3>> all;
  for (std::vector<Point<3>> some; source.read(some);) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

class GeneratedPointsOf : public ::testing::TestWithParam<std::string> {
 protected:
  const Context context_;
  RunWatch watch_{context_};
};

TEST_P(GeneratedPointsOf, AFamilyAreTheSameForAProgramAndForARun) {
  const GenerateOptions options{.family = GetParam(), .count = 3000, .seed = 5};
  GeneratedPoints for_program(options);
  GeneratedPoints for_run(options);
  RunPoints run = for_run.begin(watch_, true);
  EXPECT_EQ(run.records, 3000U);
  EXPECT_EQ(run.has_heights, for_run.header().coordinates == 3);
  const Taken taken = taken_from(*run.stream);
  EXPECT_EQ(taken.points, all_of(for_program));
  std::vector<std::uint64_t> counted(3000);
  std::iota(counted.begin(), counted.end(), 0);
  EXPECT_EQ(taken.index, counted);
  EXPECT_EQ(run.stream->counts(), PointCounts{.read = 3000});
  EXPECT_EQ(run.stream->fraction_read(), 1);
}

INSTANTIATE_TEST_SUITE_P(Families, GeneratedPointsOf,
                         ::testing::Values("uniform", "lattice", "terrain", "scan", "clusters",
                                           "utm"),
                         [](const auto& family) { return family.param; });

TEST(GeneratedPoints, ComeInBlocksAndAreNumberedThrough) {
  const Context context;
  RunWatch watch(context);
  GeneratedPoints points({.count = 70'000});
  const Taken taken = taken_from(*points.begin(watch, true).stream);
  EXPECT_THAT(taken.sizes, ElementsAre(65'536, 70'000 - 65'536));
  EXPECT_EQ(taken.index.back(), 69'999U);
}

TEST(GeneratedPoints, HaveHeightsInSpaceAndOnTerrainAndScans) {
  EXPECT_EQ(GeneratedPoints({.family = "uniform", .dimension = 2}).header().coordinates, 2);
  EXPECT_EQ(GeneratedPoints({.family = "uniform", .dimension = 3}).header().coordinates, 3);
  EXPECT_EQ(GeneratedPoints({.family = "terrain", .dimension = 2}).header().coordinates, 3);
  EXPECT_EQ(GeneratedPoints({.family = "scan", .dimension = 2}).header().coordinates, 3);
  EXPECT_EQ(GeneratedPoints({.family = "uniform", .count = 12}).header().count, 12U);
}

TEST(GeneratedPoints, OfNoneEndAtOnce) {
  GeneratedPoints points({.count = 0});
  EXPECT_TRUE(all_of(points).empty());
}

TEST(GeneratedPoints, AreTakenByOneRun) {
  const Context context;
  RunWatch watch(context);
  GeneratedPoints points({.count = 100});
  points.begin(watch, false);
  const auto again = thrown_by([&] { points.begin(watch, false); });
  ASSERT_TRUE(again);
  EXPECT_EQ(again->code(), ErrorCode::kInvalidArgument);
  EXPECT_TRUE(thrown_by([&] { all_of(points); })) << "the program's own reading, too";
}

TEST(GeneratedPoints, RefuseOptionsThatCannotBe) {
  for (const GenerateOptions& wrong : std::vector<GenerateOptions>{
           {.family = "no such family"}, {.dimension = 1}, {.dimension = 7}}) {
    const auto error = thrown_by([&] { const GeneratedPoints points(wrong); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace spillway::test

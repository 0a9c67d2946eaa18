// Tiles are triangulated while other points are still to be read, where it is known where they lie.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "src/error.h"
#include "src/parallel/parallel.h"
#include "stream/source/false_header.h"
#include "tests/error_facts.h"
#include "tests/stream/region_stream.h"
#include "tests/stream/stream_runner.h"
#include "tests/stream/triangulate/indexed_simplices.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::Gt;
using ::testing::Lt;

using Regions = std::vector<std::vector<LatticePoint>>;

struct EarlyRun {
  RunStatistics statistics;
  KeepingWriter mesh;
  bool is_early = false;
};

EngineOptions small_tiles() {
  return {.asked = {.input_index = true, .tile_points = 600, .leaf_points = 100},
          .threads = 2,
          .buffered_points = 1U << 20};
}

template <int D>
EarlyRun run(RegionStream source, const EngineOptions& options = small_tiles()) {
  EarlyRun run{{}, KeepingWriter(D)};
  QuietSetup setup(options);
  run.statistics = triangulate_stream<D>(source, run.mesh, setup);
  run.is_early = source.kept_to_plan;
  EXPECT_EQ(run.mesh.live(), 0U);
  EXPECT_EQ(setup.budget.used(), 0U);
  return run;
}

template <int D>
IndexedSimplices<D> expected_of(const Regions& regions) {
  std::vector<Point<D>> points;
  for (const auto& region : regions) {
    for (const LatticePoint& point : region) {
      Point<D>& p = points.emplace_back();
      std::copy_n(point.begin(), D, p.begin());
    }
  }
  return triangulated<D>(points);
}

TEST(EarlyTriangulation, OfASurveyIsThatOfAllPoints) {
  const Regions regions = survey(8, 20'000, 1);
  const EarlyRun early = run<2>(RegionStream(regions));
  EXPECT_TRUE(early.is_early);
  EXPECT_EQ(simplices_of<2>(early.mesh), expected_of<2>(regions));
  EXPECT_EQ(early.statistics.mesh.points, 20'000U);
  EXPECT_EQ(early.statistics.mesh.vertices, 20'000U);
}

TEST(EarlyTriangulation, OfSpaceIsThatOfAllPoints) {
  const Regions regions = survey(5, 8'000, 2);
  const EarlyRun early = run<3>(RegionStream(regions));
  EXPECT_TRUE(early.is_early);
  EXPECT_EQ(simplices_of<3>(early.mesh), expected_of<3>(regions));
}

TEST(EarlyTriangulation, WritesItsFirstBlockEarlyAndSpillsNothing) {
  const EarlyRun early = run<2>(RegionStream(survey(12, 60'000, 3)));
  EXPECT_THAT(early.statistics.first_block_read_points, Lt(9'000U));
  EXPECT_EQ(early.statistics.spilled_points, 0U);
}

TEST(EarlyTriangulation, IsTheSameForAnyNumberOfThreads) {
  const Regions regions = survey(7, 15'000, 4, 0.3);
  EngineOptions options = small_tiles();
  std::vector<std::vector<std::uint64_t>> corners;
  for (const unsigned threads : {1U, 2U, 3U, 4U}) {
    options.threads = threads;
    corners.push_back(run<2>(RegionStream(regions), options).mesh.corner_list);
  }
  for (const auto& other : corners) EXPECT_EQ(other, corners.front());
}

/// Points on a lattice: many are equal, many on one circle, many on the cuts.
TEST(EarlyTriangulation, TakesEqualPointsOfSeveralInputsInTheInputsOrder) {
  for (const unsigned seed : {5U, 6U, 7U}) {
    const Regions regions = survey(6, 12'000, seed, 0.4, 10);
    EngineOptions options = small_tiles();
    const EarlyRun early = run<2>(RegionStream(regions), options);
    options.asked.trust_headers = false;
    const EarlyRun late = run<2>(RegionStream(regions), options);
    EXPECT_TRUE(early.is_early);
    EXPECT_FALSE(late.is_early);
    EXPECT_EQ(simplices_of<2>(early.mesh), simplices_of<2>(late.mesh));
    EXPECT_EQ(early.statistics.mesh.canonical_hash, late.statistics.mesh.canonical_hash);
    const auto heights = [](const EarlyRun& run) {
      return std::multiset<LatticePoint>(run.mesh.vertices.begin(), run.mesh.vertices.end());
    };
    EXPECT_EQ(heights(early), heights(late)) << "z of the first of several equal points";
  }
}

TEST(EarlyTriangulation, SpillsPointsThatWaitLongestWhereMemoryIsLittle) {
  const Regions regions = survey(8, 40'000, 8, 0.2);
  EngineOptions options = small_tiles();
  options.buffered_points = 6'000;
  const EarlyRun early = run<2>(RegionStream(regions), options);
  EXPECT_TRUE(early.is_early);
  EXPECT_THAT(early.statistics.spilled_points, Gt(0U));
  EXPECT_THAT(early.statistics.spilled_points, Lt(40'000U));
  EXPECT_EQ(simplices_of<2>(early.mesh), expected_of<2>(regions));
}

/// Cells that get far more points than their regions let expect are cut, also when parts of them
/// are on the disk, on both sides of the cut.
TEST(EarlyTriangulation, CutsCellsThatGetMoreThanTheyExpect) {
  for (const std::size_t buffered : {std::size_t{1} << 20, std::size_t{4'000}}) {
    Regions regions = survey(6, 10'000, 9);
    std::mt19937 random(10);
    std::normal_distribution<double> spread(0, 0.02);
    for (std::size_t r = 0; r < regions.size(); r += 5) {
      const LatticePoint center = regions[r].front();
      for (int i = 0; i < 2'000; ++i) {
        regions[r].push_back({center[0] + spread(random), center[1] + spread(random), 0});
      }
    }
    EngineOptions options = small_tiles();
    options.buffered_points = buffered;
    const EarlyRun early = run<2>(RegionStream(regions), options);
    EXPECT_TRUE(early.is_early);
    EXPECT_EQ(simplices_of<2>(early.mesh), expected_of<2>(regions));
  }
}

TEST(EarlyTriangulation, TakesRegionsThatCoverAllAndSuchAsHaveNoPoints) {
  Regions regions = survey(8, 20'000, 11);
  std::mt19937 random(12);
  std::uniform_real_distribution<double> coordinate(0, 8);
  std::vector<LatticePoint> everywhere(500);
  for (LatticePoint& point : everywhere) point = {coordinate(random), coordinate(random), 1};
  regions.push_back(everywhere);
  regions.insert(regions.begin(), 3, {});
  RegionStream source(regions);
  source.told()[0].box = Box<3>{{100, 100, 0}, {200, 200, 0}};
  const EarlyRun early = run<2>(std::move(source));
  EXPECT_TRUE(early.is_early);
  EXPECT_EQ(simplices_of<2>(early.mesh), expected_of<2>(regions));
}

/// Boxes may be much larger than what is in them: then less is final early, and no more than that.
TEST(EarlyTriangulation, TakesBoxesThatAreTooLarge) {
  const Regions regions = survey(8, 20'000, 13);
  RegionStream source(regions);
  for (InputRegion& region : source.told()) {
    for (int k = 0; k < 3; ++k) {
      region.box.lo[k] -= 0.4;
      region.box.hi[k] += 0.7;
    }
  }
  const EarlyRun early = run<2>(std::move(source));
  EXPECT_TRUE(early.is_early);
  EXPECT_EQ(simplices_of<2>(early.mesh), expected_of<2>(regions));
}

/// As in rotated strips: cells that no point lies in, and tiles at the rim of the empty ones.
TEST(EarlyTriangulation, TakesBoxesThatAreEmptyInPart) {
  Regions regions;
  std::mt19937 random(14);
  std::uniform_real_distribution<double> along(0, 10);
  std::uniform_real_distribution<double> across(-0.3, 0.3);
  for (int strip = 0; strip < 12; ++strip) {
    std::vector<LatticePoint>& points = regions.emplace_back();
    for (int i = 0; i < 1'500; ++i) {
      const double t = along(random);
      points.push_back({t + across(random) + strip, t - across(random) - strip, 0});
    }
  }
  const EarlyRun early = run<2>(RegionStream(regions));
  EXPECT_TRUE(early.is_early);
  EXPECT_EQ(simplices_of<2>(early.mesh), expected_of<2>(regions));
}

/// What is kept because of the box of a cell that turns out to have no points is final in the end,
/// wherever the cell is, and also if it is the last one.
TEST(EarlyTriangulation, TakesCellsThatEndWithoutPoints) {
  for (unsigned seed = 20; seed < 32; ++seed) {
    Regions regions = survey(5, 6'000, seed);
    std::mt19937 random(seed);
    RegionStream boxes(regions);
    for (std::size_t r = 0; r < regions.size(); ++r) {
      if (random() % 3 == 0) regions[r].clear();
    }
    RegionStream source(regions);
    for (std::size_t r = 0; r < regions.size(); ++r) {
      source.told()[r].box = boxes.told()[r].box;
      source.told()[r].count = boxes.told()[r].count;
    }
    const EarlyRun early = run<2>(std::move(source));
    EXPECT_TRUE(early.is_early);
    EXPECT_EQ(simplices_of<2>(early.mesh), expected_of<2>(regions)) << seed;
  }
}

TEST(EarlyTriangulation, OfOneRegionWithPointsAmongEmptyOnesIsComplete) {
  for (std::size_t only = 0; only < 9; ++only) {
    const Regions all = survey(3, 9'000, 40);
    Regions regions(9);
    regions[only] = all[only];
    RegionStream boxes(all);
    RegionStream source(regions);
    for (std::size_t r = 0; r < regions.size(); ++r) {
      source.told()[r].box = boxes.told()[r].box;
      source.told()[r].count = 1'000;
    }
    const EarlyRun early = run<2>(std::move(source));
    EXPECT_EQ(simplices_of<2>(early.mesh), expected_of<2>(regions)) << only;
  }
}

TEST(EarlyTriangulation, ReadsAllFirstWhereThatIsNoGain) {
  const Regions regions = {survey(1, 5'000, 15)[0], survey(1, 5'000, 16)[0]};
  const EarlyRun late = run<2>(RegionStream(regions));
  EXPECT_FALSE(late.is_early) << "both regions cover all";
  EXPECT_EQ(simplices_of<2>(late.mesh), expected_of<2>(regions));
}

/// A sink that must know the extent, and what it was told of it.
struct ExtentRun : RunSink {
  explicit ExtentRun(bool trust, double most) : trusts(trust), tolerance(most) {}

  [[nodiscard]] bool wants_extent() const override { return true; }
  bool extent_told(const Box<2>& extent, std::uint64_t /*points*/) override {
    told.push_back(extent);
    return trusts;
  }
  bool extent_holds(const Box<2>& extent) override {
    return std::abs(extent.lo[0] - told[0].lo[0]) <= tolerance;
  }
  void extent_known(const Box<2>& extent, std::uint64_t points) override {
    EXPECT_EQ(points, 20'000U);
    known.push_back(extent);
  }
  BlockSink* begin_again() override { return &mesh.emplace(2); }

  bool trusts;
  double tolerance;
  std::vector<Box<2>> told;
  std::vector<Box<2>> known;
  int times_read = 0;
  bool is_early = false;
  std::optional<KeepingWriter> mesh{2};
};

ExtentRun run_by_extent(RegionStream source, bool trusts = true, double tolerance = 0) {
  ExtentRun run(trusts, tolerance);
  QuietSetup setup(small_tiles());
  const RunStatistics statistics = triangulate_stream<2>(
      source, *run.mesh, {setup.options, *setup.scratch, setup.budget, run, setup.progress});
  EXPECT_EQ(statistics.mesh.points, 20'000U);
  EXPECT_EQ(setup.budget.used(), 0U);
  run.times_read = source.times_read;
  run.is_early = source.kept_to_plan;
  return run;
}

RegionStream with_a_wide_region(const Regions& regions) {
  RegionStream source(regions);
  for (InputRegion& region : source.told()) {
    if (region.box.lo[0] < 0.5) region.box.lo[0] -= 0.25;
  }
  return source;
}

TEST(EarlyTriangulation, TakesTheExtentThatHeadersTell) {
  const Regions regions = survey(8, 20'000, 18);
  const ExtentRun run = run_by_extent(RegionStream(regions));
  EXPECT_TRUE(run.is_early);
  EXPECT_EQ(run.told.size(), 1U);
  EXPECT_TRUE(run.known.empty());
  EXPECT_EQ(run.times_read, 1);
  EXPECT_EQ(simplices_of<2>(*run.mesh), expected_of<2>(regions));
}

TEST(EarlyTriangulation, BeginsAgainWhereHeadersTellALargerExtent) {
  const Regions regions = survey(8, 20'000, 19);
  const ExtentRun run = run_by_extent(with_a_wide_region(regions));
  EXPECT_TRUE(run.is_early);
  EXPECT_EQ(run.times_read, 2);
  ASSERT_EQ(run.known.size(), 1U);
  EXPECT_EQ(run.known[0], *RegionStream(regions).told_extent());
  EXPECT_EQ(simplices_of<2>(*run.mesh), expected_of<2>(regions));
}

TEST(EarlyTriangulation, GoesOnWhereALargerExtentMakesNoDifference) {
  const Regions regions = survey(8, 20'000, 20);
  const ExtentRun run = run_by_extent(with_a_wide_region(regions), true, 0.5);
  EXPECT_EQ(run.times_read, 1);
  EXPECT_TRUE(run.known.empty());
  EXPECT_EQ(simplices_of<2>(*run.mesh), expected_of<2>(regions));
}

TEST(EarlyTriangulation, ReadsAllFirstWhereTheToldExtentWillNotDo) {
  const Regions regions = survey(8, 20'000, 21);
  const ExtentRun run = run_by_extent(RegionStream(regions), false);
  EXPECT_FALSE(run.is_early);
  ASSERT_EQ(run.known.size(), 1U);
  EXPECT_EQ(run.known[0], run.told[0]);
  EXPECT_EQ(simplices_of<2>(*run.mesh), expected_of<2>(regions));
}

TEST(EarlyTriangulation, SaysThatPointsCannotBeReadAgain) {
  RegionStream source = with_a_wide_region(survey(8, 20'000, 22));
  source.most_times_read = 1;
  const ErrorFacts facts = facts_of([&source] { run_by_extent(source); });
  EXPECT_EQ(facts.remedy, Remedy::kDistrustHeaders);
}

/// A run of which a box is false, and what was told of it.
/// A sink that takes its blocks back, and what users are told.
template <int D>
struct SecondRun : RunSink, RunProgress {
  BlockSink* begin_again() override { return &mesh.emplace(D); }
  void begin_phase(const char* phase) override { phases.emplace_back(phase); }
  void end_phase(std::uint64_t /*points*/) override { phases.emplace_back("end"); }
  void warn(std::string_view text) override { warnings.emplace_back(text); }

  int times_read = 0;
  std::vector<std::string> warnings;
  std::vector<std::string> phases;
  RunStatistics statistics;
  std::optional<KeepingWriter> mesh{D};
};

template <int D>
SecondRun<D> run_again(RegionStream source) {
  SecondRun<D> run;
  QuietSetup setup(small_tiles());
  run.statistics = triangulate_stream<D>(source, *run.mesh,
                                         {setup.options, *setup.scratch, setup.budget, run, run});
  EXPECT_TRUE(source.kept_to_plan);
  EXPECT_EQ(run.mesh->live(), 0U);
  EXPECT_EQ(setup.budget.used(), 0U);
  run.times_read = source.times_read;
  return run;
}

/// The last region of those that are read has half of its box.
RegionStream with_a_false_box(const Regions& regions, int axis) {
  RegionStream source(regions);
  Box<3>& box = source.told().back().box;
  box.hi[axis] = (box.lo[axis] + box.hi[axis]) / 2;
  return source;
}

TEST(EarlyTriangulation, BeginsAgainWhereAPointLiesOutsideOfItsBox) {
  const Regions regions = survey(8, 20'000, 23);
  for (const int axis : {0, 1}) {
    const SecondRun<2> again = run_again<2>(with_a_false_box(regions, axis));
    EXPECT_EQ(again.times_read, 2);
    EXPECT_THAT(
        again.warnings,
        ElementsAre("a box is false: all points are read again before any is triangulated"));
    EXPECT_THAT(again.phases, ElementsAre("read", "end", "read", "end", "triangulate", "end"));
    EXPECT_EQ(again.statistics.mesh.points, 20'000U);
    EXPECT_EQ(again.statistics.first_block_read_points, 20'000U);
    EXPECT_EQ(simplices_of<2>(*again.mesh), expected_of<2>(regions));
  }
}

TEST(EarlyTriangulation, BeginsAgainInSpaceWhereAHeightLiesOutsideOfItsBox) {
  const Regions regions = survey(5, 8'000, 24);
  const SecondRun<3> again = run_again<3>(with_a_false_box(regions, 2));
  EXPECT_EQ(again.times_read, 2);
  EXPECT_EQ(simplices_of<3>(*again.mesh), expected_of<3>(regions));
}

TEST(EarlyTriangulation, TakesEmptyAndInvertedBoxesForFalseOnes) {
  const Regions regions = survey(8, 20'000, 25);
  const Box<3> box = RegionStream(regions).told().back().box;
  for (const Box<3>& told : {Box<3>{}, Box<3>{box.hi, box.lo}, Box<3>{box.lo, box.lo}}) {
    RegionStream source(regions);
    source.told().back().box = told;
    const SecondRun<2> again = run_again<2>(source);
    EXPECT_EQ(again.times_read, 2);
    EXPECT_EQ(simplices_of<2>(*again.mesh), expected_of<2>(regions));
  }
}

TEST(EarlyTriangulation, EndsWithTheFalseBoxWherePointsOrBlocksAreGone) {
  RegionStream source = with_a_false_box(survey(8, 20'000, 26), 0);
  EXPECT_THROW(run<2>(source), FalseHeader) << "nobody takes blocks back";
  source.most_times_read = 1;
  EXPECT_THROW(run_again<2>(source), FalseHeader);
}

TEST(EarlyTriangulation, BeginsAgainWithTheRightExtentAfterAFalseBox) {
  const Regions regions = survey(8, 20'000, 27);
  const ExtentRun run = run_by_extent(with_a_false_box(regions, 0));
  EXPECT_EQ(run.times_read, 2);
  ASSERT_EQ(run.known.size(), 1U);
  EXPECT_EQ(run.known[0], *RegionStream(regions).told_extent());
  EXPECT_EQ(simplices_of<2>(*run.mesh), expected_of<2>(regions));
}

TEST(EarlyTriangulation, RefusesPointsOfALine) {
  Regions regions(20);
  for (int i = 0; i < 20'000; ++i) regions[i / 1'000].push_back({i * 1.0, i * 2.0, 0});
  EXPECT_THROW(run<2>(RegionStream(regions)), Failure);
}

/// Fails when its third block comes.
class FullSink : public BlockSink {
 public:
  void write(MeshStreamBlock&& /*block*/) override {
    if (++blocks_ == 3) throw Failure("the disk is full");
  }
  void finish(const MeshTotals& /*totals*/) override {}

 private:
  int blocks_ = 0;
};

TEST(EarlyTriangulation, EndsWithTheErrorOfItsSinkBeforeAllIsRead) {
  RegionStream source(survey(20, 200'000, 17), 100);
  FullSink sink;
  QuietSetup setup(small_tiles());
  EXPECT_THROW(triangulate_stream<2>(source, sink, setup), Failure);
  EXPECT_THAT(source.points_read(), Lt(200'000U));
  EXPECT_EQ(setup.budget.used(), 0U);
}

}  // namespace
}  // namespace spillway::test

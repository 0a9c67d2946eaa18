// The engine of one process: from a feed of points to a stream and the border that is left.

#include "stream/triangulate/tile_engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "src/error.h"
#include "src/parallel/parallel.h"
#include "tests/stream/kept_trace.h"
#include "tests/stream/stream_runner.h"
#include "tests/stream/triangulate/indexed_simplices.h"

namespace spillway::test {
namespace {

using ::testing::Each;
using ::testing::Ge;
using ::testing::IsEmpty;

/// Gives points in batches, with indices from `first_index` on.
class Feed : public PointFeed {
 public:
  template <std::size_t D>
  explicit Feed(const std::vector<std::array<double, D>>& points, std::uint64_t first_index = 0)
      : first_index_(first_index) {
    for (const auto& p : points) {
      LatticePoint& point = points_.emplace_back();
      std::copy(p.begin(), p.end(), point.begin());
    }
  }

  bool fetch(SourcePiece& piece) override {
    piece.raw.clear();
    PointBlock& block = piece.raw.decoded;
    for (; next_ < points_.size() && block.size() < 777; ++next_) {
      block.points.push_back(points_[next_]);
      block.index.push_back(first_index_ + next_);
    }
    return block.size() > 0;
  }
  void decode(SourcePiece& piece, PointBlock& block) override {
    std::swap(piece.raw.decoded, block);
  }

 private:
  std::uint64_t first_index_;
  std::vector<LatticePoint> points_;
  std::size_t next_ = 0;
};

/// An engine and all that it needs.
template <int D>
struct EngineRun {
  explicit EngineRun(const EngineOptions& of = small()) : setup(of) {}

  static EngineOptions small() {
    return {.asked = {.input_index = true, .tile_points = 400, .leaf_points = 80}, .threads = 2};
  }

  void spill(const std::vector<Point<D>>& points, std::uint64_t first_index = 0) {
    Feed feed(points, first_index);
    with_threads(engine.threads(), [&] {
      engine.spill(feed);
      engine.divide_large();
    });
    root = engine.take_nodes();
  }
  Border<D> triangulate(const Outside<D>& outside = {}) {
    Border<D> border;
    with_threads(engine.threads(), [&] { border = engine.triangulate(*root, outside); });
    return border;
  }

  QuietSetup setup;
  KeepingWriter mesh{D};
  std::optional<TileNode<D>> root;
  TileEngine<D> engine{{}, mesh, setup, setup.resting};
};

template <typename Dimension>
class TileEngineTest : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(TileEngineTest, Dimensions);

TYPED_TEST(TileEngineTest, TriangulatesTilesAndMergesThem) {
  constexpr int kD = TypeParam::value;
  const auto points = random_points<kD>(5000, 1);
  const auto expected = triangulated<kD>(points);
  EngineRun<kD> run;
  run.spill(points);
  EXPECT_EQ(run.engine.points(), points.size());
  const Border<kD> border = run.triangulate();
  EXPECT_THAT(border.simplices, IsEmpty());
  EXPECT_EQ(simplices_of<kD>(run.mesh), expected);
  EXPECT_EQ(run.mesh.live(), 0U);
  const RunStatistics statistics = run.engine.statistics();
  EXPECT_EQ(statistics.mesh.points, points.size());
  EXPECT_EQ(statistics.mesh.vertices, points.size());
  EXPECT_EQ(statistics.mesh.simplices, expected.size());
  EXPECT_GT(statistics.tiles, 5000U / 400);
  EXPECT_GT(statistics.leaves, statistics.tiles);
  EXPECT_GT(std::accumulate(statistics.final_by_level.begin(), statistics.final_by_level.end(),
                            std::uint64_t{0}),
            0U);
}

TYPED_TEST(TileEngineTest, TellsEachNodeOnceAfterItsChildren) {
  constexpr int kD = TypeParam::value;
  KeptTrace trace;
  const std::vector<TaskNode>& told = trace.nodes;
  EngineOptions options = EngineRun<kD>::small();
  options.asked.trace = std::shared_ptr<RunTrace>(std::shared_ptr<void>(), &trace);
  EngineRun<kD> run(options);
  run.spill(random_points<kD>(5000, 1));
  run.triangulate();
  const RunStatistics statistics = run.engine.statistics();
  std::map<std::uint32_t, const TaskNode*> waiting;
  std::uint64_t tiles = 0;
  for (const TaskNode& node : told) {
    std::size_t points = node.task.points;
    std::uint32_t level = 0;
    for (const std::uint32_t child : node.children) {
      ASSERT_TRUE(waiting.contains(child));
      points -= waiting[child]->task.points;
      level = std::max(level, waiting[child]->level + 1);
      waiting.erase(child);
    }
    EXPECT_EQ(node.level, level);
    EXPECT_EQ(points, node.children.empty() ? node.task.points : 0U);
    tiles += node.children.empty() ? 1 : 0;
    ASSERT_TRUE(waiting.emplace(node.number, &node).second);
  }
  ASSERT_EQ(waiting.size(), 1U);
  EXPECT_EQ(waiting.begin()->first + 1, told.size());
  EXPECT_EQ(tiles, statistics.tiles);
  std::uint64_t leaves = 0;
  std::uint64_t merges = 0;
  for (const TaskSum& sum : run.engine.task_sums()) {
    if (sum.scope == TaskScope::kInTile && sum.level == 0 && sum.kind == TaskKind::kBaseCase) {
      leaves += sum.tasks;
    }
    if (sum.scope == TaskScope::kBetweenTiles && sum.kind == TaskKind::kNode) {
      merges += sum.tasks;
    }
  }
  EXPECT_EQ(leaves, statistics.leaves);
  EXPECT_EQ(merges, told.size() - tiles);
}

TYPED_TEST(TileEngineTest, AFailureOfWhoIsToldOfTasksEndsTheRun) {
  EngineOptions options = EngineRun<TypeParam::value>::small();
  class Failing : public RunTrace {
   public:
    [[nodiscard]] bool takes_nodes() const override { return true; }
    void node(const TaskNode& node) override {
      if (node.number > 3) throw InvalidArgument("enough of it");
    }
  } trace;
  options.asked.trace = std::shared_ptr<RunTrace>(std::shared_ptr<void>(), &trace);
  EngineRun<TypeParam::value> run(options);
  run.spill(random_points<TypeParam::value>(5000, 1));
  EXPECT_THROW(run.triangulate(), InvalidArgument);
}

TYPED_TEST(TileEngineTest, HasNoTilesWithoutPoints) {
  constexpr int kD = TypeParam::value;
  EngineRun<kD> run;
  run.spill({});
  EXPECT_FALSE(run.root);
  EXPECT_EQ(run.engine.points(), 0U);
  EXPECT_FALSE(run.engine.is_to_divide());
}

TYPED_TEST(TileEngineTest, PutsOtherIndicesInPlaceOfThoseThatCame) {
  constexpr int kD = TypeParam::value;
  EngineRun<kD> run;
  run.spill(random_points<kD>(1500, 2));
  run.engine.replace_indices([](std::span<std::uint64_t> index) {
    for (std::uint64_t& i : index) i += 10'000;
  });
  run.triangulate();
  EXPECT_THAT(run.mesh.index, Each(Ge(10'000U)));
  EXPECT_EQ(std::set(run.mesh.index.begin(), run.mesh.index.end()).size(), 1500U);
}

TEST(TileEngine, DividesTilesAgainThatBecameTooLarge) {
  const std::vector<Point<2>> points = random_points<2>(300'000, 4);
  EngineRun<2> run({.asked = {.input_index = true, .tile_points = 1000},
                    .threads = 2,
                    .buffered_points = 40 * PointBuffer::kChunk});
  Feed feed(points);
  with_threads(2, [&] { run.engine.spill(feed); });
  EXPECT_TRUE(run.engine.is_to_divide());
  std::uint64_t divided = 0;
  with_threads(2, [&] { divided = run.engine.divide_large(); });
  EXPECT_GT(divided, 0U);
  EXPECT_FALSE(run.engine.is_to_divide());
  EXPECT_EQ(run.engine.take_nodes()->points, points.size());
  const RunStatistics statistics = run.engine.statistics();
  EXPECT_EQ(statistics.divided_points, divided);
  EXPECT_GT(statistics.spilled_points, 0U);
}

/// Fails when its second block comes.
class FullSink : public BlockSink {
 public:
  void write(MeshStreamBlock&& /*block*/) override {
    if (++blocks_ == 2) throw Failure("the disk is full");
  }
  void finish(const MeshTotals& /*totals*/) override {}

 private:
  int blocks_ = 0;
};

TEST(TileEngine, EndsWithTheErrorOfItsSink) {
  QuietSetup setup(EngineRun<2>::small());
  {
    FullSink sink;
    TileEngine<2> engine({}, sink, setup, setup.resting);
    Feed feed(random_points<2>(20'000, 5));
    std::string message;
    with_threads(2, [&] {
      engine.spill(feed);
      try {
        engine.triangulate(*engine.take_nodes(), {});
      } catch (const Failure& error) {
        message = error.what();
      }
    });
    EXPECT_EQ(message, "the disk is full");
  }
  EXPECT_EQ(setup.budget.used(), 0U) << "all leases are given back";
}

TEST(TileEngine, RefusesALimitThatIsTooSmall) {
  QuietSetup setup({}, 1000);
  KeepingWriter mesh(2);
  EXPECT_THROW(TileEngine<2>({}, mesh, setup, setup.resting), InvalidArgument);
}

}  // namespace
}  // namespace spillway::test

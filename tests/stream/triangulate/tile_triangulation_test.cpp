// A tile gives the stream what nothing outside can change, and a merge the rest: together they are
// the triangulation of all points.

#include "stream/triangulate/tile_triangulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>

#include "src/error.h"
#include "src/parallel/parallel.h"
#include "tests/error_facts.h"
#include "tests/stream/stream_runner.h"
#include "tests/stream/triangulate/indexed_simplices.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// What tiles and merges share, and the stream that they make.
template <int D>
class Bench {
 public:
  explicit Bench(std::size_t leaf_points = 60) {
    context.leaf_points = leaf_points;
    context.output.input_index = true;
  }

  /// Runs a tile of points whose indices count from `first` on.
  Border<D> tile(std::uint32_t slot, const std::vector<Point<D>>& points, std::uint64_t first,
                 const Outside<D>& outside) {
    TilePoints<D> loaded;
    loaded.resize(points.size(), true, 0);
    loaded.points = points;
    std::iota(loaded.index.begin(), loaded.index.end(), first);
    return tile(slot, std::move(loaded), outside);
  }
  Border<D> tile(std::uint32_t slot, TilePoints<D> points, const Outside<D>& outside) {
    Border<D> border;
    Task task;
    with_threads(2, [&] {
      border = triangulate_tile<D>(context, {std::move(points), outside, slot}, task);
    });
    return border;
  }

  MemoryBudget budget{std::uint64_t{1} << 30};
  StreamCounts counts{budget};
  KeepingWriter mesh{D};
  Sequencer<D> sequencer{mesh, budget, {}, counts.times};
  std::atomic<int> leaves_told = 0;
  TriangulateOptions asked;
  TileContext<D> context{.asked = asked,
                         .output = {},
                         .budget = budget,
                         .sequencer = sequencer,
                         .counts = counts,
                         .progress = [this] { ++leaves_told; }};
};

template <int D>
TileNode<D> node_of(const std::vector<Point<D>>& points) {
  TileNode<D> node;
  for (const Point<D>& point : points) node.box.expand(point);
  node.points = points.size();
  return node;
}

/// Points in two tiles, by x, those of the first one in front.
template <int D>
struct TwoTiles {
  explicit TwoTiles(std::vector<Point<D>> points) : all(std::move(points)) {
    const auto middle =
        std::stable_partition(all.begin(), all.end(), [](const Point<D>& p) { return p[0] < 0.5; });
    low.assign(all.begin(), middle);
    high.assign(middle, all.end());
    root = node_of<D>(all);
    root.children = {node_of<D>(low), node_of<D>(high)};
  }

  std::vector<Point<D>> all;
  std::vector<Point<D>> low;
  std::vector<Point<D>> high;
  TileNode<D> root;
};

template <typename Dimension>
class TileTriangulation : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(TileTriangulation, Dimensions);

TYPED_TEST(TileTriangulation, OfATileAloneIsAll) {
  constexpr int kD = TypeParam::value;
  const auto points = random_points<kD>(1000, 1);
  Bench<kD> bench;
  const Border<kD> border = bench.tile(0, points, 0, {});
  EXPECT_THAT(border.simplices, IsEmpty());
  EXPECT_THAT(border.vertices, IsEmpty());
  EXPECT_EQ(simplices_of<kD>(bench.mesh), triangulated<kD>(points));
  EXPECT_EQ(bench.mesh.live(), 0U) << "all vertices are finalized";
  EXPECT_EQ(bench.counts.points, points.size());
  EXPECT_GT(bench.counts.leaves, 1000U / 60);
  EXPECT_EQ(bench.counts.leaves, static_cast<std::uint64_t>(bench.leaves_told));
}

// More levels of merges than an exposure has bits.
TEST(TileTriangulationOfManyLevels, IsAll) {
  const auto points = random_points<2>(80'000, 7);
  Bench<2> bench(1);
  EXPECT_THAT(bench.tile(0, points, 0, {}).simplices, IsEmpty());
  EXPECT_EQ(simplices_of<2>(bench.mesh), triangulated<2>(points));
}

TYPED_TEST(TileTriangulation, HasATaskForEachLeafAndMerge) {
  constexpr int kD = TypeParam::value;
  Bench<kD> bench;
  TilePoints<kD> points;
  points.resize(1000, true, 0);
  points.points = random_points<kD>(1000, 1);
  std::iota(points.index.begin(), points.index.end(), std::uint64_t{0});
  const Outside<kD> outside;
  Task tile;
  with_threads(2, [&] { triangulate_tile<kD>(bench.context, {std::move(points), outside}, tile); });
  EXPECT_EQ(tile.before.size(), 1U);
  std::uint64_t leaves = 0;
  const auto check = [&](const auto& self, const Task& task) -> std::size_t {
    EXPECT_EQ(task.kind, task.children.empty() ? TaskKind::kBaseCase : TaskKind::kNode);
    EXPECT_EQ(task.after.size(), task.children.empty() ? 0U : 3U);
    leaves += task.children.empty() ? 1 : 0;
    std::size_t below = task.children.empty() ? task.points : 0;
    for (const Task& child : task.children) below += self(self, child);
    EXPECT_EQ(below, task.points);
    return task.points;
  };
  EXPECT_EQ(check(check, tile), 1000U);
  EXPECT_EQ(leaves, bench.counts.leaves);
}

TYPED_TEST(TileTriangulation, OfTwoTilesAndTheirMergeIsAll) {
  constexpr int kD = TypeParam::value;
  const TwoTiles<kD> tiles(random_points<kD>(1500, 2));
  const auto expected = triangulated<kD>(tiles.all);
  Bench<kD> bench;
  const TileNode<kD>& root = tiles.root;
  std::vector<Border<kD>> borders;
  borders.push_back(bench.tile(0, tiles.low, 0, {&root.children[1]}));
  const auto of_low = simplices_of<kD>(bench.mesh);
  EXPECT_GT(of_low.size(), expected.size() / 10);
  EXPECT_TRUE(among<kD>(of_low, expected)) << "what the other tile may change was written";
  EXPECT_FALSE(borders[0].simplices.empty());
  borders.push_back(bench.tile(1, tiles.high, tiles.low.size(), {&root.children[0]}));
  Task task;
  MergedTiles<kD> merged;
  with_threads(2, [&] {
    merged = merge_tiles<kD>(bench.context, {borders, root, {}, {2, 0}}, task);
  });
  EXPECT_THAT(merged.border.simplices, IsEmpty());
  EXPECT_GT(merged.final_simplices, 0U);
  EXPECT_EQ(simplices_of<kD>(bench.mesh), expected);
  EXPECT_EQ(bench.mesh.live(), 0U);
  EXPECT_GT(bench.counts.borders.most_simplices(), 0U);
}

TYPED_TEST(TileTriangulation, ATileWithoutSimplicesGivesAllItsPointsOn) {
  constexpr int kD = TypeParam::value;
  std::vector<Point<kD>> line(50);
  for (std::size_t i = 0; i < line.size(); ++i) {
    line[i] = {};
    line[i][1] = static_cast<double>(i / 2);  // each twice
  }
  const TileNode<kD> elsewhere = node_of<kD>({random_points<kD>(5, 4)});
  Bench<kD> bench(10);
  const Border<kD> border = bench.tile(0, line, 0, {&elsewhere});
  EXPECT_TRUE(border.open());
  EXPECT_THAT(border.vertices, SizeIs(25));
  EXPECT_EQ(bench.counts.duplicates, 25U);
  EXPECT_THAT(bench.mesh.corner_list, IsEmpty());
}

TEST(TileTriangulation, OfThePlaneChoosesHeights) {
  TilePoints<2> points;
  points.points = {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1, 0}};
  points.heights = {1, 2, 3, 9, 7};
  points.index = {50, 40, 30, 20, 10};
  Bench<2> lowest;
  lowest.asked.heights = Heights::kHighest;
  lowest.tile(0, points, {});
  std::vector<std::pair<double, std::uint64_t>> chosen;
  for (std::size_t v = 0; v < lowest.mesh.vertices.size(); ++v) {
    chosen.emplace_back(lowest.mesh.vertices[v][2], lowest.mesh.index[v]);
  }
  EXPECT_THAT(chosen, ::testing::UnorderedElementsAre(std::pair(1, 50), std::pair(9, 20),
                                                      std::pair(3, 30)));
}

TEST(ResidentBorders, TellTheMostThatThereWas) {
  MemoryBudget budget(1000);
  {
    ResidentBorders borders(budget);
    borders.add(3, 300);
    borders.add(5, 500);
    borders.remove(3, 300);
    borders.add(1, 100);
    EXPECT_EQ(borders.most_simplices(), 8U);
    EXPECT_EQ(borders.most_bytes(), 800U);
    EXPECT_EQ(budget.used(), 600U);
    const auto more = [&borders] { borders.add(1, 500); };
    EXPECT_THROW(more(), Failure);
    EXPECT_EQ(borders.most_bytes(), 800U);
  }
  EXPECT_EQ(budget.used(), 0U);
}

}  // namespace
}  // namespace spillway::test

#include "stream/triangulate/border_growth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "src/error.h"

namespace spillway::test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr std::uint64_t kTile = 10'000;

Border<2> border_of(std::size_t vertices) {
  Border<2> border;
  border.dimension = 2;
  border.vertices.resize(vertices);
  border.simplices.resize(2 * vertices);
  return border;
}

/// Works off `tiles` tiles of `all` in post-order, where a part of so many tiles has `size(tiles)`
/// vertices in its border.
template <typename Size>
Border<2> work_off(BorderGrowth<2>& growth, std::uint64_t all, std::uint64_t tiles,
                   const Size& size) {
  if (tiles == 0) return {};
  if (all == 1) {
    const Border<2> border = border_of(size(1));
    growth.add_tile(kTile, border);
    return border;
  }
  std::vector<Border<2>> children;
  children.push_back(work_off(growth, all / 2, std::min(tiles, all / 2), size));
  if (tiles > all / 2) children.push_back(work_off(growth, all / 2, tiles - all / 2, size));
  if (tiles < all) return {};
  growth.begin_merge(all * kTile, children);
  Border<2> border = border_of(size(all));
  growth.end_merge(2 * size(all / 2), border);
  return border;
}

std::size_t surface(std::uint64_t tiles) {
  return static_cast<std::size_t>(400 * std::sqrt(static_cast<double>(tiles)));
}
std::size_t everything(std::uint64_t tiles) { return tiles * kTile; }

/// What the last merge holds: both borders twice, and their triangulation.
template <typename Size>
double last_merge(std::uint64_t tiles, const Size& size) {
  const std::size_t vertices = 2 * size(tiles / 2);
  return 2.0 * static_cast<double>(border_of(vertices).bytes()) +
         static_cast<double>(merge_bytes<2>(vertices, tiles * kTile));
}

std::uint64_t estimate(const BorderGrowth<2>& growth, std::uint64_t used, std::uint64_t all) {
  return growth.enough_for(
      {.limit = 32 * kMiB, .used = used, .loaded = 2 * kTile, .all_points = all * kTile});
}

TEST(BorderGrowth, IsThatOfTheSurfaceWhereTilesAreCompact) {
  constexpr std::uint64_t kAll = 1 << 16;
  for (const std::uint64_t done : {kAll, kAll * 3 / 4, kAll / 2, kAll / 8, kAll / 16 * 5}) {
    BorderGrowth<2> growth;
    work_off(growth, kAll, done, surface);
    const auto enough = static_cast<double>(estimate(growth, kMiB, kAll));
    EXPECT_GT(enough, last_merge(kAll, surface)) << done << " tiles done";
    EXPECT_LT(enough, 8 * last_merge(kAll, surface)) << done << " tiles done";
  }
}

TEST(BorderGrowth, IsThatOfThePointsWhereAllOfThemAreInTheBorder) {
  constexpr std::uint64_t kAll = 1 << 10;
  BorderGrowth<2> growth;
  work_off(growth, kAll, kAll / 4, everything);
  EXPECT_GT(static_cast<double>(estimate(growth, 0, kAll)), last_merge(kAll, everything));
}

TEST(BorderGrowth, LooksAtTheMergeThatIsRefused) {
  constexpr std::uint64_t kAll = 1 << 10;
  BorderGrowth<2> growth;
  work_off(growth, kAll, kAll / 2, surface);
  const std::uint64_t before = estimate(growth, kMiB, kAll);
  const std::vector<Border<2>> children(2, border_of(surface(kAll / 2)));
  growth.begin_merge(kAll * kTile, children);
  constexpr std::uint64_t kRefused = 40 * kMiB;
  const std::uint64_t after = growth.enough_for({.limit = 32 * kMiB,
                                                 .used = kMiB,
                                                 .refused = kRefused,
                                                 .loaded = 2 * kTile,
                                                 .all_points = kAll * kTile});
  EXPECT_GT(after, before);
  EXPECT_GT(after, kRefused);
  EXPECT_LT(after, 3 * kRefused);
}

TEST(BorderGrowth, MayBeThatOfAllPointsWhereNoTileIsDone) {
  const BorderGrowth<2> growth;
  EXPECT_GT(estimate(growth, 33 * kMiB, 8), enough_memory<2>(8 * kTile, 0));
}

TEST(BorderGrowth, TellsNothingWhereTilesThemselvesTakeAllMemory) {
  BorderGrowth<2> growth;
  growth.add_tile(kTile, border_of(10));
  EXPECT_EQ(estimate(growth, 33 * kMiB, 8), 0U);
  EXPECT_GT(estimate(growth, kMiB, 8), 0U);
}

}  // namespace
}  // namespace spillway::test

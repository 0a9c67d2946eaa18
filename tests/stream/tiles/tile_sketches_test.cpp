// Sketches of tiles, which others ask in place of their points: each point lies in what they tell.

#include "stream/tiles/tile_sketches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace spillway::test {
namespace {

constexpr std::uint64_t kMuch = 1 << 20;  ///< bytes

using Points = std::vector<LatticePoint>;

/// Points of a slope over a square, of so many that a sketch has more than a few cells.
Points surface(double x, std::size_t count = 8000) {
  std::mt19937_64 random(static_cast<std::uint64_t>(x) + 1);
  Points points(count);
  for (LatticePoint& p : points) {
    p = {x + static_cast<double>(random() % 1000), static_cast<double>(random() % 1000), 0};
    p[2] = std::floor(0.7 * p[0] - 0.4 * p[1]);
  }
  return points;
}

Points solid(std::size_t count = 8000) {
  std::mt19937_64 random(1);
  Points points(count);
  for (LatticePoint& p : points) {
    for (double& c : p) c = static_cast<double>(random() % 1000);
  }
  return points;
}

HeldPoints held_of(const Points& points) {
  HeldPoints held;
  held.buffer.append({.points = points});
  for (const LatticePoint& p : points) held.box.expand(p);
  return held;
}

/// On the disk, with a sketch or without.
TileSegment segment_of(const Points& points, std::shared_ptr<CellSketch> sketch) {
  TileSegment segment;
  segment.points = points.size();
  for (const LatticePoint& p : points) segment.box.expand(p);
  if (sketch == nullptr) return segment;
  sketch->gather(points);
  sketch->measure(points);
  segment.sketches.push_back(std::move(sketch));
  return segment;
}

/// A node that is made of the only tile there is.
template <int D>
TileNode<D> sketched(const TileSketches& sketches, const Tile& tile, std::uint64_t points) {
  TileNode<D> node;
  node.points = points;
  node.stored = {0};
  sketches.sketch<D>(
      node, [&](std::uint32_t) -> const Tile& { return tile; }, points);
  return node;
}

/// But for rounding.
template <int D>
bool holds(const PointSketch<D>& sketch, const LatticePoint& point) {
  Point<D> p;
  std::copy_n(point.begin(), D, p.begin());
  const auto boxes = sketch.boxes.level(0);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    if (!boxes[b].contains(p)) continue;
    const Plate<D>& plate = sketch.plates[b];
    double along = 0;
    double squared = 0;
    for (int k = 0; k < D; ++k) {
      along += (p[k] - plate.centre[k]) * plate.normal[k];
      squared += (p[k] - plate.centre[k]) * (p[k] - plate.centre[k]);
    }
    constexpr double kRounding = 1e-6;
    if (std::abs(along) <= plate.thickness + kRounding &&
        std::sqrt(squared) <= plate.radius + kRounding) {
      return true;
    }
  }
  return false;
}

TEST(TileSketches, HoldEveryPointWhereverItIsKept) {
  TileSketches sketches(3, kMuch);
  const std::vector<Points> parts{surface(0), surface(2000), surface(4000), surface(6000, 500)};
  Tile tile;
  tile.hollow = true;
  for (const Points& points : parts) {
    for (const LatticePoint& p : points) tile.box.expand(p);
    tile.points += points.size();
  }
  tile.held.push_back(held_of(parts[0]));
  auto sketch = sketches.begin(tile, held_of(parts[1]), tile.points);
  ASSERT_NE(sketch, nullptr);
  tile.segments.push_back(segment_of(parts[1], std::move(sketch)));
  tile.segments.push_back(segment_of(parts[2], nullptr));
  tile.held.push_back(held_of(parts[3]));
  const TileNode<3> node = sketched<3>(sketches, tile, tile.points);
  ASSERT_NE(node.sketch, nullptr);
  EXPECT_GT(node.sketch->plates.size(), 8U);
  for (const Points& points : parts) {
    for (const LatticePoint& p : points) ASSERT_TRUE(holds<3>(*node.sketch, p));
  }
  EXPECT_FALSE(holds<3>(*node.sketch, {500, 500, 900})) << "beside the first slope";
}

TEST(TileSketches, OfSpaceAreMadeOfWhatIsHollowByItself) {
  const TileSketches sketches(3, kMuch);
  const auto is_sketched = [&](const Points& points, bool hollow) {
    Tile tile;
    tile.hollow = hollow;
    tile.held.push_back(held_of(points));
    tile.box = tile.held[0].box;
    return sketched<3>(sketches, tile, points.size()).sketch != nullptr;
  };
  EXPECT_TRUE(is_sketched(surface(0), false));
  EXPECT_FALSE(is_sketched(solid(), false));
  EXPECT_TRUE(is_sketched(solid(), true)) << "as was found before";
}

TEST(TileSketches, InThePlaneOnlyTheWholeTellsWhatIsHollow) {
  const TileSketches sketches(2, kMuch);
  Points curve = surface(0);
  for (LatticePoint& p : curve) p[1] = std::floor(p[0] * p[0] / 1000);
  Tile tile;
  tile.held.push_back(held_of(curve));
  tile.box = tile.held[0].box;
  EXPECT_EQ(sketched<2>(sketches, tile, curve.size()).sketch, nullptr);
  tile.hollow = true;
  const TileNode<2> node = sketched<2>(sketches, tile, curve.size());
  ASSERT_NE(node.sketch, nullptr);
  for (const LatticePoint& p : curve) ASSERT_TRUE(holds<2>(*node.sketch, p));
}

TEST(TileSketches, AreNotMadeOfTooFewPointsToTellMoreThanABox) {
  TileSketches sketches(3, kMuch);
  EXPECT_EQ(sketches.begin({}, held_of(surface(0, 900)), 900), nullptr);
  EXPECT_NE(sketches.begin({}, held_of(surface(0, 1100)), 1100), nullptr);
  EXPECT_EQ(sketches.begin({}, held_of(solid()), 8000), nullptr) << "nor of what is not hollow";
}

TEST(TileSketches, OnTheDiskTakeNoMoreThanTheirBytes) {
  for (const std::uint64_t bytes : {std::uint64_t{1} << 14, std::uint64_t{1} << 17}) {
    TileSketches sketches(3, bytes);
    const Points points = surface(0);
    std::size_t cells = 0;
    int begun = 0;
    for (auto sketch = sketches.begin({}, held_of(points), points.size()); sketch != nullptr;
         sketch = sketches.begin({}, held_of(points), points.size())) {
      sketch->gather(points);
      cells += sketch->size();
      ASSERT_LT(++begun, 1000);
    }
    EXPECT_GT(begun, 0);
    EXPECT_LE(cells * CellSketch::kCellBytes, bytes);
  }
}

TEST(TileSketches, ATileThatIsASmallPartOfAllHasFewCells) {
  const Points points = surface(0);
  const auto cells_of = [&](std::uint64_t all_points) {
    TileSketches sketches(3, kMuch);
    auto sketch = sketches.begin({}, held_of(points), all_points);
    if (sketch == nullptr) return std::size_t{0};
    sketch->gather(points);
    return sketch->size();
  };
  EXPECT_GT(cells_of(8'000), 30U);
  EXPECT_GT(cells_of(8'000), cells_of(2'000'000));
  EXPECT_EQ(cells_of(100'000'000), 0U);
}

}  // namespace
}  // namespace spillway::test

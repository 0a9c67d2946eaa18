#pragma once
// Points in the orders in which they come from files, and the tiles that a TileTree makes of them.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <ostream>
#include <random>
#include <utility>
#include <vector>

#include "gtest/gtest.h"
#include "src/parallel/parallel.h"
#include "stream/tiles/tile_tree.h"

namespace spillway::detail {

enum class Order {
  kRandom,
  kSorted,
  kFlightLines,
  kStrips,    ///< each overlaps half of the one before, and is flown the other way
  kOutwards,  ///< from the middle
  kCurve,     ///< cell by cell of a quadtree
  kSkewed,    ///< nine tenths in a hundredth of the area
  kCluster,   ///< nine tenths in a millionth of it
  kEqual,     ///< half of them
  kRepeated   ///< half of them at one of a hundred places
};

inline void PrintTo(Order order, std::ostream* out) {
  constexpr std::array kNames = {"Random", "Sorted", "FlightLines", "Strips", "Outwards",
                                 "Curve",  "Skewed", "Cluster",     "Equal",  "Repeated"};
  *out << kNames.at(static_cast<std::size_t>(order));
}

/// Sorts points by a key of each.
template <typename F>
void sort_by(std::vector<LatticePoint>& points, F&& key) {
  std::sort(points.begin(), points.end(),
            [&](const LatticePoint& a, const LatticePoint& b) { return key(a) < key(b); });
}

/// Points in a unit square or, if z is not to be their number, a unit cube.
inline std::vector<LatticePoint> make_points(Order order, std::size_t count, bool numbered = true) {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<LatticePoint> points(count);
  for (LatticePoint& p : points) p = {unit(random), unit(random), unit(random)};
  const auto strip = [](const LatticePoint& p) {  // told by z which of two
    return std::floor(40 * p[0]) - (p[2] < 0.5 ? 1 : 0);
  };
  switch (order) {
    case Order::kRandom:
      break;
    case Order::kSorted:
      std::sort(points.begin(), points.end());
      break;
    case Order::kFlightLines:
      sort_by(points, [](const LatticePoint& p) { return std::pair(std::floor(20 * p[0]), p[1]); });
      break;
    case Order::kStrips:
      sort_by(points, [&](const LatticePoint& p) {
        return std::pair(strip(p), std::fmod(strip(p), 2) == 0 ? p[1] : -p[1]);
      });
      break;
    case Order::kOutwards:
      sort_by(points, [](const LatticePoint& p) { return std::hypot(p[0] - 0.5, p[1] - 0.5); });
      break;
    case Order::kCurve: {
      std::vector<std::pair<std::uint64_t, LatticePoint>> keyed;
      for (const LatticePoint& p : points) {
        std::uint64_t key = 0;
        for (int bit = 1; bit <= 20; ++bit) {
          for (const int k : {1, 0}) {
            key = 2 * key + (static_cast<std::uint64_t>(std::ldexp(p[k], bit)) & 1U);
          }
        }
        keyed.emplace_back(key, p);
      }
      std::ranges::sort(keyed);
      for (std::size_t i = 0; i < count; ++i) points[i] = keyed[i].second;
      break;
    }
    case Order::kSkewed:
    case Order::kCluster:
      for (std::size_t i = 0; i < count; ++i) {
        if (i % 10 == 0) continue;
        for (double& x : points[i]) x = order == Order::kSkewed ? x * 0.1 : 0.3 + x * 1e-3;
      }
      break;
    case Order::kEqual:
      for (std::size_t i = 0; i < count; i += 2) points[i] = {0.25, 0.75, 0.5};
      break;
    case Order::kRepeated:
      for (std::size_t i = 0; i < count; i += 2) {
        for (double& x : points[i]) x = std::floor(10 * x) / 10;
        points[i][2] = 0.5;
      }
      break;
  }
  for (std::size_t i = 0; numbered && i < count; ++i) points[i][2] = static_cast<double>(i);
  return points;
}

/// What is told of points before they come.
struct Knowledge {
  bool count = false;
  bool extent = false;
};

template <int D>
struct DealtTile {
  Box<D> box;              ///< as the tree has it
  std::size_t stored = 0;  ///< tiles that it is made of, one after the other
  std::shared_ptr<const PointSketch<D>> sketch;
  TilePoints<D> points;
};

template <int D>
struct DealtTiles {
  std::vector<DealtTile<D>> tiles;  ///< in the order of the tree
  std::uint64_t written = 0;
  std::uint64_t left_over = 0;  ///< to be dealt again
  std::uint64_t divided = 0;
  bool nest_at_first = false;  ///< before they were divided evenly, if they were
  bool nest = false;

  /// How often a point was written, on average.
  [[nodiscard]] double writes() const {
    std::size_t points = 0;
    for (const DealtTile<D>& tile : tiles) points += tile.points.points.size();
    return static_cast<double>(written) / static_cast<double>(points);
  }
};

struct Dealing {
  std::size_t capacity = 1000;
  std::size_t buffered = 40 * PointBuffer::kChunk;
  std::size_t block = 777;
  unsigned threads = 2;
  Knowledge known{};
  bool evenly = false;  ///< divide all anew at the end
  std::size_t largest_undivided = 0;
  bool carry = false;  ///< points carry three bytes each, by carried_by()
};

inline std::array<std::byte, 3> carried_by(std::uint64_t number) {
  return {std::byte{7}, static_cast<std::byte>(number), static_cast<std::byte>(number >> 8)};
}

/// Deals points, whose numbers are their indices.
template <int D>
DealtTiles<D> deal_into_tiles(const std::vector<LatticePoint>& points, const Dealing& dealing) {
  const auto scratch = make_scratch_folder(testing::TempDir(), std::nullopt);
  StageTimes times;
  TileTreeOptions options{.dimension = D,
                          .capacity = dealing.capacity,
                          .buffered_points = dealing.buffered,
                          .index = true,
                          .record_size = dealing.carry ? carried_by(0).size() : 0,
                          .sketch_bytes = std::uint64_t{1} << 20,
                          .largest_undivided = dealing.largest_undivided};
  if (dealing.known.count) options.expected = points.size();
  if (dealing.known.extent) {
    options.extent = Box<3>();
    for (const LatticePoint& p : points) options.extent->expand(p);
  }
  DealtTiles<D> dealt;
  with_threads(dealing.threads, [&] {
    TileTree tree(options, *scratch, times);
    std::size_t next = 0;
    tree.fill([&](PointBlock& block) {
      const std::size_t count = std::min(dealing.block, points.size() - next);
      const auto begin = points.begin() + static_cast<std::ptrdiff_t>(next);
      block.points.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
      block.index.resize(count);
      block.attributes.clear();
      for (std::uint64_t& index : block.index) {
        if (dealing.carry)
          std::ranges::copy(carried_by(next), std::back_inserter(block.attributes));
        index = next++;
      }
      return count > 0;
    });
    std::uint64_t told = 0;
    double share = 0;
    dealt.left_over = tree.points_to_divide();
    dealt.divided = tree.divide_large([&](std::uint64_t done, double fraction) {
      EXPECT_GE(done, told);
      EXPECT_GE(fraction, share);
      EXPECT_LE(fraction, 1);
      told = done;
      share = fraction;
    });
    EXPECT_LE(told, dealt.divided);
    dealt.nest_at_first = tree.nests();
    if (dealing.evenly) {
      tree.divide_evenly();
      dealt.divided += tree.divide_large([](std::uint64_t /*done*/, double /*fraction*/) {});
    }
    dealt.nest = tree.nests();
    EXPECT_EQ(tree.points_to_divide(), 0U);
    EXPECT_EQ(tree.points(), points.size());
    const auto visit = [&](const auto& self, const TileNode<D>& node) -> void {
      for (const auto& child : node.children) self(self, child);
      if (!node.leaf()) return;
      dealt.tiles.push_back(
          {node.box, node.stored.size(), node.sketch, tree.decode<D>(tree.read(node))});
      EXPECT_EQ(dealt.tiles.back().points.points.size(), node.points);
    };
    if (const auto root = tree.take_nodes<D>()) visit(visit, *root);
    dealt.written = tree.points_written();
  });
  return dealt;
}

}  // namespace spillway::detail

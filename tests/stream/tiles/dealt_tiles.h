#pragma once
// The tiles that a TileTree makes of points.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <vector>

#include "gtest/gtest.h"
#include "src/parallel/parallel.h"
#include "stream/tiles/tile_tree.h"

namespace spillway::test {

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

/// Sees to it that what is told of points that are dealt again ascends.
class AscendingProgress final : public DealingWatch {
 public:
  void dealt_again(std::uint64_t points, double fraction) override {
    EXPECT_GE(points, told);
    EXPECT_GE(fraction, share_);
    EXPECT_LE(fraction, 1);
    told = points;
    share_ = fraction;
  }
  void begin_again() { told = 0, share_ = 0; }

  std::uint64_t told = 0;

 private:
  double share_ = 0;
};

/// Deals points, whose numbers are their indices.
template <int D>
DealtTiles<D> deal_into_tiles(const std::vector<LatticePoint>& points, const Dealing& dealing) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
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
    AscendingProgress progress;
    TileTree tree(options, *scratch, times, progress);
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
    dealt.left_over = tree.points_to_divide();
    dealt.divided = tree.divide_large();
    EXPECT_LE(progress.told, dealt.divided);
    dealt.nest_at_first = tree.nests();
    if (dealing.evenly) {
      tree.divide_evenly();
      progress.begin_again();
      dealt.divided += tree.divide_large();
    }
    dealt.nest = tree.nests();
    EXPECT_EQ(tree.points_to_divide(), 0U);
    EXPECT_EQ(tree.points(), points.size());
    const auto visit = [&](const auto& self, const TileNode<D>& node) -> void {
      for (const auto& child : node.children) self(self, child);
      if (!node.leaf()) return;
      dealt.tiles.push_back({node.box, node.stored.size(), node.sketch,
                             tree.loader().decode<D>(tree.loader().read(node))});
      EXPECT_EQ(dealt.tiles.back().points.points.size(), node.points);
    };
    if (const auto root = tree.take_nodes<D>()) visit(visit, *root);
    dealt.written = tree.points_written();
  });
  return dealt;
}

}  // namespace spillway::test

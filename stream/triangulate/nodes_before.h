#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "stream/tiles/tile_node.h"
#include "stream/triangulate/border.h"

namespace spillway::stream {

/// A cell of a plan that is complete, with its tiles; none if it has no points.
template <int D>
struct CompleteCell {
  std::uint32_t cell = 0;
  std::optional<TileNode<D>> tiles;

  template <typename State>
  void state(State& state) {
    state(cell, tiles);
  }
};

/// The nodes that a process before this one was done with: all below a number. Of those of them
/// whose parents were not done, the borders are kept, in the order of the numbers.
template <int D>
class NodesBefore {
 public:
  [[nodiscard]] bool has(std::uint32_t node) const { return node < done_; }

  /// The border of a node, once; an empty one if it went into its parent.
  Border<D> take_border(std::uint32_t node) {
    const auto kept = std::ranges::lower_bound(borders_, node, {}, &KeptBorder::node);
    if (kept == borders_.end() || kept->node != node) return {};
    return std::exchange(kept->border, {});
  }

  template <typename State>
  void state(State& state) {
    state(done_, borders_);
  }

 private:
  struct KeptBorder {
    std::uint32_t node = 0;
    Border<D> border;

    template <typename State>
    void state(State& state) {
      state(node, border);
    }
  };

  std::uint32_t done_ = 0;
  std::vector<KeptBorder> borders_;
};

}  // namespace spillway::stream

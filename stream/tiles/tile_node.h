#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "src/delaunay/border/point_sketch.h"
#include "src/geometry/box.h"
#include "stream/tiles/shared_children.h"

namespace spillway::stream {

/// A node of the finished tree over tiles: a tile that can be loaded, or two nodes.
template <int D>
struct TileNode {
  Box<D> box;  ///< tight around its points
  std::uint64_t points = 0;
  SharedChildren<TileNode> children;  ///< none for a tile
  std::vector<std::uint32_t> stored;  ///< of a tile: the stored tiles it is made of
  /// Of a tile, where its points lie, if that is known more closely.
  std::shared_ptr<const PointSketch<D>> sketch{};

  [[nodiscard]] std::uint64_t size() const { return points; }
  [[nodiscard]] bool leaf() const { return children.empty(); }

  template <typename State>
  void state(State& state) {
    state(box, points, stored);
    std::uint64_t count = children.size();
    state(count);
    for (std::uint64_t c = 0; c < count; ++c)
      state(State::kReads ? children.emplace_back() : children[c]);
    sketch_state(state);
  }

 private:
  template <typename State>
  void sketch_state(State& state) {
    bool there = sketch != nullptr;
    state(there);
    if (!there) return;
    std::vector<Box<D>> boxes;
    std::vector<Plate<D>> plates;
    if constexpr (!State::kReads) {
      if (sketch->boxes.levels() > 0) {
        boxes.assign(sketch->boxes.level(0).begin(), sketch->boxes.level(0).end());
      }
      plates = sketch->plates;
    }
    state(boxes, plates);
    if constexpr (State::kReads) {
      sketch = std::make_shared<const PointSketch<D>>(
          PointSketch<D>{RunBoxes<D>(std::move(boxes)), std::move(plates)});
    }
  }
};

/// A balanced tree over tiles, of which there is at least one: the two sides of a node have about
/// as many points each, and their boxes overlap little. In which order the tiles come makes no
/// difference but between equal ones.
template <int D>
TileNode<D> tree_over(std::vector<TileNode<D>> tiles);

}  // namespace spillway::stream

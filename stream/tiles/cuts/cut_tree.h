#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "src/delaunay/division/cut.h"
#include "src/geometry/framed_point.h"
#include "stream/tiles/cuts/cut_lookup.h"

namespace spillway::stream {

/// A cut of a part that came of the cuts before it, numbered from 0 on: each leaves its number to
/// what is below, and what is not gets the next one.
struct DivisionCut {
  std::uint32_t part = 0;
  Cut where{};
};

/// Which tile a point belongs to: a k-d tree of cuts whose cells reach to infinity, so that it
/// knows a tile for points anywhere. Points on a cut go up; equal points always go together.
class CutTree {
 public:
  /// A node of the tree, for walking it: a tile, or a cut with two sides.
  using NodeRef = std::int32_t;

  /// One tile, number 0, that holds everything. Only the first `dimension` axes are cut.
  explicit CutTree(int dimension);

  /// The tile of each point, in about the logarithm of their number of steps, however the tiles
  /// came about; in one step where it is that of the point before.
  void find_tiles(std::span<const LatticePoint> points, std::span<std::uint32_t> tiles) const;

  [[nodiscard]] std::uint32_t tiles() const { return tiles_; }

  /// Divides a tile by some cuts: it keeps its number for part 0, the others get new ones in order.
  void split(std::uint32_t tile, std::span<const DivisionCut> cuts);

  /// Cuts a tile in two: it keeps its number for what is below `value` on `axis`. Returns the cut.
  NodeRef cut(std::uint32_t tile, int axis, double value);
  /// The same for one of many cuts: find_tiles() works again after renew_lookup().
  NodeRef make_cut(std::uint32_t tile, int axis, double value);
  void renew_lookup();

  /// Number of cuts; the next one gets it as its reference.
  [[nodiscard]] NodeRef cuts() const { return static_cast<NodeRef>(cuts_.size()); }
  [[nodiscard]] NodeRef root() const { return root_; }
  [[nodiscard]] static bool is_tile(NodeRef ref) { return ref < 0; }
  [[nodiscard]] static std::uint32_t tile_at(NodeRef ref) {
    return static_cast<std::uint32_t>(-ref - 1);
  }
  [[nodiscard]] static NodeRef ref_of(std::uint32_t tile) {
    return -static_cast<NodeRef>(tile) - 1;
  }
  /// What is a tile's: from `lo` on, below `hi`, which are infinite where no cut is.
  [[nodiscard]] const Box<3>& cell(std::uint32_t tile) const { return cells_[tile]; }
  [[nodiscard]] std::array<NodeRef, 2> sides(NodeRef ref) const { return cuts_[ref].sides; }

  template <typename State>
  void state(State& state) {
    state(root_, tiles_, cuts_, parents_, cells_);
    if constexpr (State::kReads) {
      since_.resize(tiles_);
      cuts_since_.resize(tiles_);
      renew_lookup();
    }
  }

 private:
  /// 1 or 0.
  [[nodiscard]] unsigned is_in_cell(const LatticePoint& point, std::uint32_t tile) const;
  template <std::size_t kPoints>
  void walk(const LatticePoint* points, std::uint32_t* tiles,
            std::integral_constant<std::size_t, kPoints> count) const;

  int dimension_;
  NodeRef root_ = ref_of(0);
  std::uint32_t tiles_ = 1;
  std::vector<CutNode> cuts_;
  std::vector<NodeRef> parents_{-1};             ///< by tile: the cut above it, or -1
  std::vector<Box<3>> cells_{whole_space<3>()};  ///< by tile
  /// Finds the tile as it was when this was made; of that tile `since_` has what it is now.
  CutLookup lookup_;
  std::vector<NodeRef> since_{ref_of(0)};
  std::vector<int> cuts_since_{0};  ///< by tile: cuts above it that the lookup does not have
  int most_cuts_since_ = 0;
  std::uint32_t all_cuts_since_ = 0;
};

}  // namespace spillway::stream

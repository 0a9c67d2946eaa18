#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stream/tiles/cuts/cut_tree.h"
#include "stream/tiles/cuts/tile_cut.h"
#include "stream/tiles/dealing_watch.h"
#include "stream/tiles/storage/tile.h"
#include "stream/tiles/tile_table.h"

namespace spillway::stream {

/// Cuts tiles: the first one into many, those that outgrow their share, and long ones. Segments on
/// the disk that lie on both sides of a cut are left over, to be dealt once more.
class TileDivider {
 public:
  /// Both must outlive it.
  TileDivider(TileTable& table, DealingWatch& watch) : table_(table), watch_(watch) {}

  /// Whether all points, which are in memory, had better be one tile; it may have so many then.
  bool stays_whole();

  /// Divides the one tile that there is at first, all of whose points are in memory, for those that
  /// are to come, too, if it is known where they will lie. Returns what is to be dealt to the tiles
  /// that there are now.
  [[nodiscard]] std::vector<HeldPoints> divide_first();

  /// Divides a tile that is too large. Returns the same.
  [[nodiscard]] std::vector<HeldPoints> divide(std::uint32_t number);

  /// Puts the tiles of those cuts in place of all. Returns the old tiles in the order of the tree,
  /// to be dealt: all that they have is what waits.
  [[nodiscard]] std::vector<Tile> replace_tiles(CutTree cuts);

  /// Cuts a tile in two if it has outgrown its share, and its halves likewise.
  void cut_outgrown(std::uint32_t number);
  /// Cuts tiles across that are too long.
  void cut_long();
  /// Likewise below a node to which no more points come, but leaves nothing over.
  void cut_long_below(CutTree::NodeRef ref);

  [[nodiscard]] bool too_large(const Tile& tile) const;
  /// Points of tiles that are too large, and those left over.
  [[nodiscard]] std::uint64_t points_to_divide() const;

  [[nodiscard]] std::uint64_t left_over_points() const { return left_over_points_; }
  [[nodiscard]] bool left_over_below(CutTree::NodeRef ref) const;
  /// Those of a cut before those of the cuts below it, so that what is dealt after each other goes
  /// to tiles near each other.
  [[nodiscard]] std::vector<TileSegment> take_left_over();

  template <typename State>
  void state(State& state) {
    state(left_over_, left_over_points_);
  }

 private:
  std::vector<HeldPoints> divide(std::uint32_t number, std::vector<LatticePoint> sample,
                                 std::size_t tile_count, bool representative);
  void judge_tiles(std::span<const LatticePoint> sample);
  [[nodiscard]] bool outgrown(const Tile& tile) const;
  [[nodiscard]] bool will_be_too_large(const Tile& tile) const;
  [[nodiscard]] bool is_too_long(std::uint32_t number) const;
  [[nodiscard]] bool to_be_cut(std::uint32_t number, bool complete) const;
  void cut_in_two(std::uint32_t number, bool complete);
  void deal_segments(Tile& whole, CutTree::NodeRef ref, const Cut& cut,
                     const std::array<std::uint32_t, 2>& halves);
  void deal_to_halves(HeldPoints held, const Cut& cut, const std::array<std::uint32_t, 2>& halves);
  void leave_over(CutTree::NodeRef cut, TileSegment segment);
  void append_left_over(CutTree::NodeRef ref, std::vector<TileSegment>& segments);

  TileTable& table_;
  DealingWatch& watch_;
  std::vector<std::vector<TileSegment>> left_over_;  ///< by cut
  std::uint64_t left_over_points_ = 0;
};

}  // namespace spillway::stream

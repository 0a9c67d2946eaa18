#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/delaunay/border/conflict_region_batch.h"
#include "src/delaunay/border/point_search.h"
#include "src/delaunay/division/divide.h"
#include "stream/tiles/tile_node.h"
#include "stream/triangulate/border.h"

namespace spillway::stream {

/// Where everything else is: the roots of the trees of boxes that are not this tile's.
template <int D>
using Outside = std::vector<const TileNode<D>*>;

/// What may change simplices of a part of a tile: the siblings of the part, of the node above it,
/// and so on, by level, and other tiles.
template <int D>
struct Surroundings {
  std::vector<std::vector<const Part<D>*>> levels;
  const Outside<D>& outside;
  std::span<const Point<D>> points{};    ///< of the tile
  std::span<const RunBoxes<D>> boxes{};  ///< of the tile's leaves, by list
  bool asks_for_points = false;          ///< of siblings; else boxes are all that is asked

  /// Whether there are few enough levels to tell what each may change.
  [[nodiscard]] bool tells_exposure() const {
    return !levels.empty() && levels.size() <= kExposureLevels;
  }

  /// Some parts of the tile, to be asked as is said here.
  [[nodiscard]] Siblings<D> siblings(std::span<const Part<D>* const> parts) const {
    return {parts, points, boxes, asks_for_points ? Siblings<D>::kMostBoxes : 0};
  }

  [[nodiscard]] std::vector<const Part<D>*> all_siblings() const {
    std::vector<const Part<D>*> all;
    for (const auto& level : levels) all.insert(all.end(), level.begin(), level.end());
    return all;
  }

  /// The bits of those regions asked for that meet the box of another tile.
  [[nodiscard]] std::uint64_t may_meet_tiles(const ConflictRegionBatch<D>& regions,
                                             std::uint64_t asked) const {
    std::uint64_t met = 0;
    for (const TileNode<D>* tile : outside) met |= regions.may_meet_leaf(*tile, asked & ~met);
    return met;
  }
};

/// Asks what may change regions of a part, one batch after the other.
template <int D>
class ChangeSearch {
 public:
  /// `surroundings` must outlive it. Points are asked for in so many steps for each level.
  ChangeSearch(const Surroundings<D>& surroundings, std::size_t steps)
      : surroundings_(surroundings) {
    for (const auto& level : surroundings.levels) {
      searches_.emplace_back(surroundings.siblings(level), steps);
    }
  }

  /// The bits of regions that something may change. If `exposure` is given, sets that of each.
  [[nodiscard]] std::uint64_t may_change(const ConflictRegionBatch<D>& regions,
                                         Exposure* exposure) {
    std::uint64_t changed = 0;
    for (std::size_t level = 0; level < searches_.size(); ++level) {
      // Who wants to know the exposure asks for each level.
      const std::uint64_t asked = exposure != nullptr ? regions.all() : regions.all() & ~changed;
      std::uint64_t held = searches_[level].may_hold_points(regions, asked);
      changed |= held;
      if (exposure == nullptr) continue;
      for (; held != 0; held &= held - 1) {
        exposure[std::countr_zero(held)] |= static_cast<Exposure>(1U << level);
      }
    }
    return changed | surroundings_.may_meet_tiles(regions, regions.all() & ~changed);
  }

 private:
  const Surroundings<D>& surroundings_;
  std::vector<PointSearch<D>> searches_;  ///< by level
};

}  // namespace spillway::stream

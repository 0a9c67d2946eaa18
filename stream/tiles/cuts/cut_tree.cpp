#include "stream/tiles/cuts/cut_tree.h"

#include <algorithm>
#include <utility>

namespace spillway::stream {
namespace {

/// Cuts of a tile that the lookup does without, and of all tiles, one in so many.
constexpr int kMostCutsSince = 6;
constexpr std::uint32_t kTilesPerCutSince = 8;
/// Points whose tiles are looked for side by side.
constexpr std::size_t kTogether = 8;

}  // namespace

CutTree::CutTree(int dimension)
    : dimension_(dimension), lookup_({{whole_space<3>(), ref_of(0)}}, dimension) {}

CutTree::NodeRef CutTree::make_cut(std::uint32_t tile, int axis, double value) {
  const auto ref = static_cast<NodeRef>(cuts_.size());
  const NodeRef above = parents_[tile];
  const std::uint32_t other = tiles_++;
  cuts_.push_back({value, axis, {ref_of(tile), ref_of(other)}});
  if (above < 0) {
    root_ = ref;
  } else {
    auto& sides = cuts_[above].sides;
    sides[sides[0] == ref_of(tile) ? 0 : 1] = ref;
  }
  cells_.push_back(cells_[tile]);
  cells_.back().lo[axis] = value;
  cells_[tile].hi[axis] = value;
  parents_[tile] = ref;
  parents_.push_back(ref);
  if (cuts_since_[tile] == 0) since_[tile] = ref;
  since_.push_back(ref_of(other));
  cuts_since_.push_back(++cuts_since_[tile]);
  most_cuts_since_ = std::max(most_cuts_since_, cuts_since_.back());
  ++all_cuts_since_;
  return ref;
}

void CutTree::find_tiles(std::span<const LatticePoint> points,
                         std::span<std::uint32_t> tiles) const {
  std::uint32_t tile = 0;
  for (std::size_t i = 0; i < points.size();) {
    const std::size_t count = std::min(kTogether, points.size() - i);
    std::size_t inside = 0;
    while (inside < count && is_in_cell(points[i + inside], tile) != 0) ++inside;
    if (inside == count) {
      std::fill_n(&tiles[i], count, tile);
    } else if (count == kTogether) {
      walk(&points[i], &tiles[i], std::integral_constant<std::size_t, kTogether>());
    } else {
      for (std::size_t k = 0; k < count; ++k) {
        walk(&points[i + k], &tiles[i + k], std::integral_constant<std::size_t, 1>());
      }
    }
    i += count;
    tile = tiles[i - 1];
  }
}

unsigned CutTree::is_in_cell(const LatticePoint& point, std::uint32_t tile) const {
  const Box<3>& cell = cells_[tile];
  unsigned inside = 1;
  for (int k = 0; k < dimension_; ++k) {
    inside &= static_cast<unsigned>(point[k] >= cell.lo[k]) &
              static_cast<unsigned>(point[k] < cell.hi[k]);
  }
  return inside;
}

/// Side by side, as each step of a walk waits for the one before; and as many steps for each point
/// as for the deepest tile, as nobody can tell where a walk ends.
template <std::size_t kPoints>
void CutTree::walk(const LatticePoint* points, std::uint32_t* tiles,
                   std::integral_constant<std::size_t, kPoints> /*count*/) const {
  const CutNode* const lookup = lookup_.cuts().data();
  std::array<NodeRef, kPoints> refs;
  refs.fill(lookup_.root());
  for (int step = 0; step < lookup_.depth(); ++step) {
    for (std::size_t i = 0; i < kPoints; ++i) {
      const CutNode& cut = lookup[std::max(refs[i], 0)];
      const NodeRef next = cut.sides[points[i][cut.axis] >= cut.value ? 1 : 0];
      refs[i] = refs[i] >= 0 ? next : refs[i];
    }
  }
  for (std::size_t i = 0; i < kPoints; ++i) {
    NodeRef ref = since_[tile_at(refs[i])];
    while (ref >= 0) {
      const CutNode& cut = cuts_[ref];
      ref = cut.sides[points[i][cut.axis] >= cut.value ? 1 : 0];
    }
    tiles[i] = tile_at(ref);
  }
}

void CutTree::renew_lookup() {
  std::vector<TileCell> cells;
  for (std::uint32_t tile = 0; tile < tiles_; ++tile) cells.push_back({cells_[tile], ref_of(tile)});
  lookup_ = CutLookup(std::move(cells), dimension_);
  for (std::uint32_t tile = 0; tile < tiles_; ++tile) since_[tile] = ref_of(tile);
  std::ranges::fill(cuts_since_, 0);
  most_cuts_since_ = 0;
  all_cuts_since_ = 0;
}

CutTree::NodeRef CutTree::cut(std::uint32_t tile, int axis, double value) {
  const NodeRef ref = make_cut(tile, axis, value);
  const bool many = all_cuts_since_ > tiles_ / kTilesPerCutSince;
  if (many || most_cuts_since_ > kMostCutsSince) renew_lookup();
  return ref;
}

void CutTree::split(std::uint32_t tile, std::span<const DivisionCut> cuts) {
  const std::uint32_t next = tiles_;
  for (const DivisionCut& cut : cuts) {
    make_cut(cut.part == 0 ? tile : next + cut.part - 1, cut.where.axis, cut.where.value);
  }
  renew_lookup();
}

}  // namespace spillway::stream

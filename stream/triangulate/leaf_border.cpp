#include "stream/triangulate/leaf_border.h"

#include <cstring>
#include <numeric>

#include "src/delaunay/border/border_search.h"
#include "src/delaunay/border/facing_sides.h"
#include "src/geometry/dimensions.h"

namespace spillway::stream {
namespace {

/// What is known of a simplex: the bits of its exposure, and one above them for what another tile
/// may change, or any part where levels are too many to tell.
using Marks = std::uint32_t;
constexpr Marks kChanged = Marks{1} << kExposureLevels;
/// Known to be final by itself.
constexpr Marks kFinal = kChanged << 1;

/// So many steps a search may take for each point of the leaf: about as long as its triangulation.
constexpr std::size_t kStepsOfPoint = 128;

/// The simplices of a leaf, of which those that have a certain bit are found, for
/// search_border_alone().
template <int D>
class LeafMesh {
 public:
  using Id = std::uint32_t;

  LeafMesh(const LeafPart<D>& part, const BaseCase<D>& leaf)
      : part_(part),
        simplices_(leaf.simplices.span()),
        marks_(simplices_.size(), leaf.not_inside ? kFinal : 0) {
    if (!leaf.not_inside) return;
    for (const std::uint32_t s : *leaf.not_inside) marks_[s] = 0;
  }

  void find(Marks bit) { bit_ = bit; }
  [[nodiscard]] std::span<const Marks> marks() const { return marks_; }

  [[nodiscard]] std::span<const Point<D>> positions() const { return part_.points; }
  [[nodiscard]] std::array<VertexId, D + 1> corners(Id id) const {
    std::array<VertexId, D + 1> corners = simplices_[id].vertices;
    for (VertexId& v : corners) v = v == kInfiniteVertex ? v : v - part_.first_vertex;
    return corners;
  }
  [[nodiscard]] Id neighbour(Id id, int i) const { return simplices_[id].neighbours[i]; }
  [[nodiscard]] bool found(Id id) const { return (marks_[id] & (bit_ | kFinal)) != 0; }
  [[nodiscard]] bool set_found(Id id) {
    const bool is_new = !found(id);
    marks_[id] |= bit_;
    return is_new;
  }

 private:
  const LeafPart<D>& part_;
  std::span<const Simplex<D>> simplices_;
  std::vector<Marks> marks_;
  Marks bit_ = kChanged;
};

/// Adds the sides that the leaves of a tree lie beyond. False if one of them overlaps.
template <int D>
bool add_leaves_of(const TileNode<D>& tree, FacingSides<D>& sides) {
  if (sides.add(tree.box)) return true;
  return !tree.leaf() && std::ranges::all_of(tree.children, [&](const TileNode<D>& child) {
    return add_leaves_of(child, sides);
  });
}

template <int D>
class LeafBorderSearch {
 public:
  LeafBorderSearch(const LeafPart<D>& part, Surroundings<D> surroundings, BaseCase<D>& leaf)
      : part_(part), surroundings_(std::move(surroundings)), leaf_(leaf), mesh_(part, leaf) {
    if (surroundings_.tells_exposure()) {
      for (std::size_t level = 0; level < surroundings_.levels.size(); ++level) {
        search_siblings(surroundings_.levels[level], Marks{1} << level);
      }
    } else {
      search_siblings(surroundings_.all_siblings(), kChanged);
    }
    search_tiles();
  }

  LeafFates tell() {
    LeafFates told{.fates = std::vector<Fate>(leaf_.simplices.size(), Fate::kFinal)};
    for (const std::uint32_t s : leaf_.hull) told.fates[s] = Fate::kFinalFacet;
    std::vector<std::uint32_t>& open = leaf_.not_inside.emplace();
    const std::span<const Marks> marks = mesh_.marks();
    for (std::uint32_t s = 0; s < marks.size(); ++s) {
      if ((marks[s] & ~kFinal) != 0) told.fates[s] = Fate::kKept;
      if (told.fates[s] == Fate::kFinal) continue;
      open.push_back(s);
      leaf_.open_simplices.push_back(leaf_.simplices[s]);
      if (surroundings_.tells_exposure()) {
        told.exposure.push_back(static_cast<Exposure>(marks[s]));
      }
    }
    return told;
  }

 private:
  [[nodiscard]] std::vector<std::uint32_t> beside(const FacingSides<D>& sides) const {
    std::vector<std::uint32_t> starts;
    std::ranges::copy_if(leaf_.hull, std::back_inserter(starts), [&](std::uint32_t s) {
      return sides.have_corner(mesh_.corners(s), part_.points);
    });
    return starts;
  }

  void search_siblings(std::span<const Part<D>* const> parts, Marks bit) {
    FacingSides<D> sides(part_.box);
    for (const Part<D>* part : parts) {
      if (!sides.add(part->box)) throw std::logic_error("boxes of parts that lie apart on no axis");
    }
    mesh_.find(bit);
    const Siblings<D> siblings = surroundings_.siblings(parts);
    PointSearch<D> search(siblings, kStepsOfPoint * part_.points.size());
    search_border_alone<D>(beside(sides), mesh_, [&search](const ConflictRegionBatch<D>& regions) {
      return search.may_hold_points(regions, regions.all());
    });
  }

  /// Where boxes of tiles overlap, their points may lie inside of the leaf: all are looked at.
  void search_tiles() {
    FacingSides<D> sides(part_.box);
    const bool apart = std::ranges::all_of(surroundings_.outside, [&](const TileNode<D>* tile) {
      return add_leaves_of(*tile, sides);
    });
    std::vector<std::uint32_t> starts;
    if (apart) {
      starts = beside(sides);
    } else {
      starts.resize(leaf_.simplices.size());
      std::iota(starts.begin(), starts.end(), 0U);
    }
    mesh_.find(kChanged);
    search_border_alone<D>(std::move(starts), mesh_, [this](const ConflictRegionBatch<D>& regions) {
      return surroundings_.may_meet_tiles(regions, regions.all());
    });
  }

  const LeafPart<D>& part_;
  Surroundings<D> surroundings_;
  BaseCase<D>& leaf_;
  LeafMesh<D> mesh_;
};

/// Corners are half as large: each comes to lie where nothing is read any more.
template <int D>
void keep_corners(BaseCase<D>& leaf) {
  const std::size_t count = leaf.simplices.size();
  Slab memory = leaf.simplices.take_slab();
  auto* const bytes = static_cast<std::byte*>(memory.data());
  for (std::size_t s = 0; s < count; ++s) {
    std::array<VertexId, D + 1> corners;
    std::memcpy(&corners, bytes + s * sizeof(Simplex<D>), sizeof corners);
    std::memcpy(bytes + s * sizeof corners, &corners, sizeof corners);
  }
  leaf.corners = {std::move(memory), count};
}

}  // namespace

template <int D>
LeafFates search_leaf_border(const LeafPart<D>& part, Surroundings<D> surroundings,
                             BaseCase<D>& leaf) {
  LeafFates told = LeafBorderSearch<D>(part, std::move(surroundings), leaf).tell();
  keep_corners(leaf);
  return told;
}

template <int D>
LeafFates test_leaf_border(const LeafToSettle<D>& leaf, const Surroundings<D>& surroundings) {
  const std::span<const std::uint32_t> open = leaf.open;
  LeafFates told{.fates = std::vector<Fate>(leaf.simplex_count(), Fate::kFinal)};
  if (surroundings.tells_exposure()) told.exposure.resize(open.size());
  ChangeSearch<D> search(surroundings, kStepsOfPoint * leaf.points.size());
  for_each_region_batch<D>(
      open.size(), [&](std::size_t i) { return leaf.open_simplex(i); }, leaf.points,
      [&](std::size_t first, const ConflictRegionBatch<D>& regions) {
        const std::uint64_t changed =
            search.may_change(regions, told.exposure.empty() ? nullptr : &told.exposure[first]);
        tell_fates(regions, changed,
                   [&](std::size_t i, Fate fate) { told.fates[open[first + i]] = fate; });
      });
  return told;
}

#define SPILLWAY_INSTANTIATE(D)                                                             \
  template LeafFates search_leaf_border(const LeafPart<D>&, Surroundings<D>, BaseCase<D>&); \
  template LeafFates test_leaf_border(const LeafToSettle<D>&, const Surroundings<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream

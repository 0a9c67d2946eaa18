#pragma once

#include <span>
#include <vector>

#include "src/delaunay/base_case/base_case.h"
#include "src/geometry/box.h"
#include "stream/triangulate/settle.h"
#include "stream/triangulate/surroundings.h"

namespace spillway::stream {

/// What becomes of the simplices of a leaf.
struct LeafFates {
  std::vector<Fate> fates;           ///< by simplex
  std::vector<Exposure> exposure{};  ///< of those that are open, if it can be told
};

/// A leaf of a tile.
template <int D>
struct LeafPart {
  std::span<const Point<D>> points;  ///< by vertex
  VertexId first_vertex = 0;         ///< the number of the first one
  Box<D> box;                        ///< tight around them
};

/// The fates of a leaf whose simplices have neighbours, by searches from its hull for what each
/// level of its surroundings may change: what lies on a curve or a surface has balls that reach far
/// but hold no point of others, and most of it is never looked at. If there are some `not_inside`,
/// all others are final. Then leaves the corners in place of the simplices, and in `not_inside` the
/// infinite and the kept ones.
template <int D>
LeafFates search_leaf_border(const LeafPart<D>& part, Surroundings<D> surroundings,
                             BaseCase<D>& leaf);

/// The fates of a leaf's simplices: those `not_inside` are tested one by one.
template <int D>
LeafFates test_leaf_border(const LeafToSettle<D>& leaf, const Surroundings<D>& surroundings);

/// Finds out the fates of simplices whose regions these are: calls set(s, fate) for each.
template <int D, typename Set>
void tell_fates(const ConflictRegionBatch<D>& regions, std::uint64_t changed, const Set& set) {
  for (std::size_t s = 0; s < regions.kSize && (regions.all() >> s & 1) != 0; ++s) {
    const bool kept = (changed >> s & 1) != 0;
    const bool infinite = (regions.infinite() >> s & 1) != 0;
    set(s, kept ? Fate::kKept : infinite ? Fate::kFinalFacet : Fate::kFinal);
  }
}

}  // namespace spillway::stream

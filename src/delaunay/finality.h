#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "src/delaunay/divide.h"
#include "src/delaunay/triangulation.h"

namespace spillway {

/// False only if no point inside any of the boxes of `others` can destroy or change the simplex:
/// its closed circumsphere (of an infinite simplex: the closed half-space beyond its facet) meets
/// none of them. Walks each part's tree of boxes down to the leaves.
template <int D>
bool may_be_changed(const Simplex<D>& simplex, std::span<const Point<D>> points,
                    std::span<const Part<D>* const> others);

/// What merging needs to remember of each simplex, in parallel with the blocks of a triangulation.
enum class Mark : std::uint8_t {
  kInterior,  ///< not in the border, or not yet looked at
  kBorder,    ///< some sibling may change it
  kSurvivor,  ///< in the border, and found again in the triangulation of the border
};
using BlockMarks = std::vector<Mark>;

/// The border of one part against its siblings: every simplex that a point of `others` may change,
/// found from the infinite simplices `hull` by a search over neighbours (such simplices are
/// connected to the hull, since all of `others` lies beyond it). Marks them kBorder and returns
/// them sorted.
template <int D>
std::vector<SimplexId> find_border(const Triangulation<D>& triangulation,
                                   std::span<const SimplexId> hull,
                                   std::span<const Part<D>* const> others,
                                   std::span<BlockMarks> marks);

}  // namespace spillway

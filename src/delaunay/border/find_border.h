#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "src/delaunay/border/point_search.h"
#include "src/delaunay/common/slab_array.h"
#include "src/delaunay/common/triangulation.h"
#include "src/geometry/box.h"

namespace spillway::delaunay {

/// What merging needs to remember of each simplex, in parallel with the lists of a triangulation.
enum class Mark : std::uint8_t {
  kInterior,  ///< not in the border, or not yet looked at
  kVague,     ///< a sibling may change it, by a region that is not tight; in the border if
              ///< connected to it by such
  kBorder,    ///< some sibling may change it
  kSurvivor,  ///< in the border, and found again in the triangulation of the border
  kFinal,     ///< no point of another part can change it: it is in no border
};
using ListMarks = SlabArray<Mark>;

/// Whether asking for points pays, told by a sample of a part's simplices.
template <int D>
bool asking_for_points_pays(const Triangulation<D>& triangulation, const Part<D>& part,
                            const Siblings<D>& siblings);

/// The border of one part, whose tight box is `box`, against its siblings: every simplex that one
/// of their points may change, found by a search over neighbours. It starts at those infinite
/// simplices of `hull` that have a corner on a side of the box beyond which a sibling lies (Where
/// the search starts, docs/algorithm-border.md). Marks them kBorder and returns them, in any order.
template <int D>
std::vector<SimplexId> find_border(const Triangulation<D>& triangulation, const Box<D>& box,
                                   std::span<const SimplexId> hull, const Siblings<D>& siblings,
                                   std::span<ListMarks> marks);

/// The same border, but for rounding, of a leaf whose border has no other simplices than
/// `candidates`, numbers in its list; in their order. What is tested lies in the order of memory,
/// and not where a search leads.
template <int D>
std::vector<SimplexId> border_among(const Triangulation<D>& triangulation, std::uint32_t list,
                                    std::span<const std::uint32_t> candidates,
                                    const Siblings<D>& siblings, std::span<ListMarks> marks);

}  // namespace spillway::delaunay

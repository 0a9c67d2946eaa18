#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/distributed/delaunay.h"
#include "src/distributed/group.h"
#include "src/distributed/growing_share.h"

namespace spillway::distributed {

/// What a merge of two halves was at this rank.
struct HalvesMerged {
  std::size_t put_apart = 0;     ///< simplices of the share that the other half might change
  std::uint64_t border = 0;      ///< points of both halves' border, of all ranks
  std::size_t triangulated = 0;  ///< points of it that this rank triangulated
};

/// Makes one triangulation of those of a group's two halves, of which the upper begins at rank
/// `middle`, as names count: each of its ranks gives the share that it has of its own half, and
/// gets its share of the whole. `merge` is the number of the merge, from the lowest on, as exposure
/// counts them. Without simplices if the points of both halves do not span D dimensions.
/// Collective, within the group.
template <int D>
HalvesMerged merge_halves(GrowingShare<D>& share, const Group& group, int middle, unsigned merge,
                          const DistributedOptions<D>& options);

}  // namespace spillway::distributed

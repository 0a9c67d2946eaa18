#pragma once

#include <vector>

#include "src/distributed/items.h"
#include "src/distributed/ranks.h"
#include "src/distributed/share.h"

namespace spillway::distributed {

template <int D>
struct NamedPoint {
  Point<D> position;
  RankIndex name;
};

/// Cuts the side along which most points of the group spread where a sample says, and moves
/// the points below to the group's first `low_ranks` ranks, those above to the others: about as
/// many to each rank. Equal points are on one side of the cut. Read from rank to rank, the points
/// of a side keep their order. Returns this rank's. Collective.
template <int D>
std::vector<NamedPoint<D>> move_to_half(std::vector<NamedPoint<D>> points, const Ranks& group,
                                        int low_ranks, const ItemLimits& limits);

}  // namespace spillway::distributed

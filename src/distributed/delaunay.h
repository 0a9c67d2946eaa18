#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "src/delaunay/common/triangulation.h"
#include "src/distributed/halving.h"
#include "src/distributed/items.h"
#include "src/distributed/ranks.h"
#include "src/distributed/share.h"

namespace spillway::distributed {

/// How ranks triangulate together. None of it changes the set of simplices.
template <int D>
struct DistributedOptions {
  /// Triangulates points of this rank alone.
  std::function<Triangulation<D>(std::vector<Point<D>> points)> triangulate;
  /// A border of fewer points is triangulated by one rank, a larger one by half of the ranks whose
  /// border it is.
  std::size_t gather_below = 0;
  /// Told of each merge inside of a border's triangulation how many points its own border has.
  std::function<void(std::uint64_t border)> inner_merge = [](std::uint64_t) {};
  ItemLimits limits{};
};

/// The Delaunay triangulation of all ranks' points, the same one that delaunay::delaunay_triangulation
/// makes of them: Algorithms 2 and 3 of Funke and Sanders, "Parallel d-D Delaunay Triangulations in
/// Shared and Distributed Memory" (ALENEX 2017); docs/algorithm-ranks.md.
/// Points are finite and may be anywhere: none at some ranks, fewer than ranks, equal ones at
/// several, of which the first in the order of ranks stands for all.
///
/// Collective. Returns this rank's share; about as many vertices are its own as any other's. Throws
/// Failure if points or simplices of one rank are too many for 32-bit numbers, or for the memory that
/// it may take; the other ranks then wait in vain, so the job has to be aborted (abort_job).
template <int D>
Share<D> delaunay_triangulation(std::vector<NamedPoint<D>> points, const Ranks& ranks,
                                const DistributedOptions<D>& options);

}  // namespace spillway::distributed

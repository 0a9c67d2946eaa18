#pragma once

#include <cstddef>
#include <vector>

#include "src/distributed/ranks.h"
#include "src/distributed/share.h"

namespace spillway::detail::distributed {

/// How distributed::delaunay does its work. None of it changes the set of simplices.
struct DistributedOptions {
  unsigned threads = 1;  ///< of this rank, for base cases; 0: as many as the machine has
  /// A border of fewer points is triangulated by one rank, a larger one by half of the ranks whose
  /// border it is.
  std::size_t gather_below = 100'000;
};

/// The Delaunay triangulation of all ranks' points, the same one that spillway::detail::delaunay
/// makes of them: Algorithms 2 and 3 of Funke and Sanders, "Parallel d-D Delaunay Triangulations in
/// Shared and Distributed Memory" (ALENEX 2017); docs/algorithm-ranks.md.
/// Points are finite and may be anywhere: none at some ranks, fewer than ranks, equal ones at
/// several. Equal points become one vertex.
///
/// Collective. Returns this rank's share; about as many vertices are its own as any other's. Throws
/// Error if points or simplices of one rank are too many for 32-bit numbers; the other ranks then
/// wait in vain, so the job has to be aborted (abort_job).
template <int D>
Share<D> delaunay(const std::vector<Point<D>>& local_points, const Ranks& ranks,
                  const DistributedOptions& options = {});

}  // namespace spillway::detail::distributed

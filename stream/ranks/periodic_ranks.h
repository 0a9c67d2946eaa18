#pragma once

#include "src/distributed/ranks.h"
#include "stream/library/run.h"

namespace spillway::ranks {

/// As triangulate_periodically(), by all ranks together: each triangulates its part of the points and
/// their copies, and rank 0 makes the periodic mesh of the blocks of all. The first margin is that of
/// points that lie evenly. Collective.
Report triangulate_periodically(Run& run, const distributed::Ranks& ranks);

}  // namespace spillway::ranks

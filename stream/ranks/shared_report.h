#pragma once

#include <spillway/figures.h>

#include "src/distributed/ranks.h"
#include "stream/ranks/rank_pipeline.h"

namespace spillway::detail {

/// The report of a run over ranks, of whose points this rank has counted some: sums over all of
/// them, the longest time for phases, and at rank 0 what each has done. Collective.
Report shared_report(const RankMesh& mesh, const PointCounts& counts,
                     const distributed::Ranks& ranks);

}  // namespace spillway::detail

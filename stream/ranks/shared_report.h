#pragma once

#include <spillway/report.h>

#include "src/distributed/ranks.h"
#include "stream/ranks/rank_pipeline.h"

namespace spillway::ranks {

/// The report of a run over ranks, of whose points this rank has counted some: sums over all of
/// them, and the longest time for phases. Collective.
Report shared_report(const RankMesh& mesh, const PointCounts& counts,
                     const distributed::Ranks& ranks);

/// At rank 0: what each of them has done. Collective.
RunSums shared_sums(const RankMesh& mesh, const distributed::Ranks& ranks);

}  // namespace spillway::ranks

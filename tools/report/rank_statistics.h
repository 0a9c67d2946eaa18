#pragma once

#include "src/distributed/ranks.h"
#include "stream/ranks/rank_pipeline.h"
#include "tools/report/statistics.h"

namespace spillway::detail {

/// Completes the figures of a run over ranks: sums over all of them (the longest time for phases),
/// and what each has done, for "ranks" of --stats, at rank 0. Collective.
void share_statistics(RunStatistics& statistics, const RankMesh& mesh,
                      const distributed::Ranks& ranks);

}  // namespace spillway::detail

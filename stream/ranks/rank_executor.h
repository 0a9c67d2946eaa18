#pragma once

#include <memory>

#include "src/distributed/ranks.h"
#include "stream/library/context/executor.h"

namespace spillway::ranks {

/// An executor that shares runs among these ranks, which must outlive it. It writes meshes to files
/// (open_mesh_output()) and DEMs, which rank 0 puts together.
std::shared_ptr<Executor> make_rank_executor(const distributed::Ranks& ranks);

}  // namespace spillway::ranks

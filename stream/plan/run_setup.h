#pragma once

#include "formats/disk/scratch_folder.h"
#include "src/runtime/memory_budget.h"
#include "stream/output/run_sink.h"
#include "stream/periodic/torus_proof.h"
#include "stream/plan/engine_options.h"
#include "stream/plan/run_progress.h"

namespace spillway::stream {

/// What a run works with. All of it outlives the run.
struct RunSetup {
  const EngineOptions& options;
  ScratchFolder& scratch;
  MemoryBudget& budget;
  RunSink& sink;  ///< who makes something of the blocks
  RunProgress& progress;
  TorusProof* torus = nullptr;  ///< gets what proves a periodic triangulation, of this process
};

}  // namespace spillway::stream

#pragma once

#include <spillway/triangulate.h>

#include <memory>
#include <optional>

#include "formats/disk/scratch_folder.h"
#include "src/runtime/memory_budget.h"
#include "stream/checkpoint/run_identity.h"
#include "stream/library/context/run_watch.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/library/points/engine_points.h"
#include "stream/plan/run_setup.h"

namespace spillway::stream {

/// A triangulation that is about to begin.
struct Run {
  const Context& context;
  RunWatch& watch;
  RunPoints points;
  EngineSink& sink;
  EngineOptions engine;
  MemoryBudget budget;  ///< without what the sink takes for itself
  std::shared_ptr<ScratchFolder> scratch;
  std::optional<RunIdentity> identity{};  ///< of a run that can go on, if it is killed

  /// For the engine.
  [[nodiscard]] RunSetup setup() { return {engine, *scratch, budget, sink, watch}; }
  /// What the mesh's header says.
  [[nodiscard]] MeshStart start() const;
};

/// Triangulates in this process, and gives all blocks to `blocks`, which are not finished yet.
Report triangulate_to(BlockSink& blocks, const RunSetup& setup, Run& run);

}  // namespace spillway::stream

#pragma once

#include <optional>

#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/mesh_stream.h"
#include "src/runtime/memory_budget.h"
#include "stream/plan/engine_options.h"
#include "stream/source/point_stream.h"

namespace spillway::detail {

/// The pipeline: reads all points of `source`, deals them into tiles, triangulates tile by tile and
/// gives what is final to `sink`, which is not finished yet. If headers are found to be false, it
/// begins again, if it can. Throws Error if the points do not span D dimensions, or if the memory
/// or the disk do not suffice; FalseHeader if it cannot begin again.
template <int D>
RunFigures triangulate_stream(PointStream& source, BlockSink& sink, ScratchFolder& scratch,
                              MemoryBudget& budget, const StreamOptions& options);

/// Throws Error (kDegenerateInput) if `max_edge` has left no simplex of the mesh.
void refuse_empty_mesh(const RunFigures& figures, const std::optional<double>& max_edge);

}  // namespace spillway::detail

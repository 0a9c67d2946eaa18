#pragma once

#include "formats/mesh_stream.h"
#include "formats/scratch_folder.h"
#include "stream/memory_budget.h"
#include "stream/point_source.h"
#include "stream/stream_options.h"

namespace spillway::detail {

/// The pipeline: reads all points of `source`, deals them into tiles, triangulates tile by tile and
/// writes what is final to `writer`, which is not finished yet. Throws Error if the points do not
/// span D dimensions, or if the memory or the disk do not suffice.
template <int D>
StreamFigures triangulate_stream(PointSource& source, MeshStreamWriter& writer,
                                 ScratchFolder& scratch, MemoryBudget& budget,
                                 const StreamOptions& options);

}  // namespace spillway::detail

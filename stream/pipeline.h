#pragma once

#include <optional>

#include "formats/meshes/common/mesh_stream.h"
#include "stream/plan/run_setup.h"
#include "stream/source/point_stream.h"

namespace spillway::stream {

/// The pipeline: reads all points of `source`, deals them into tiles, triangulates tile by tile and
/// gives what is final to `blocks`, which are not finished yet. If headers are found to be false,
/// it begins again, if it can. Throws Failure if the points do not span D dimensions, or if the
/// memory or the disk do not suffice; FalseHeader if it cannot begin again.
template <int D>
RunStatistics triangulate_stream(PointStream& source, BlockSink& blocks, const RunSetup& setup);

/// Throws Failure (kDegenerateInput) if `max_edge` has left no simplex of the mesh.
void refuse_empty_mesh(const RunStatistics& statistics, const std::optional<double>& max_edge);

}  // namespace spillway::stream

#pragma once
// Between the values of the engine and those that programs see.

#include <spillway/mesh.h>
#include <spillway/triangulate.h>

#include "formats/meshes/common/mesh_stream.h"
#include "stream/plan/stream_options.h"
#include "stream/source/point_filter.h"

namespace spillway::detail {

spillway::MeshHeader public_header(const MeshStreamHeader& header);
MeshStreamHeader stream_header(const spillway::MeshHeader& header);

spillway::MeshTotals public_totals(const MeshTotals& totals);
MeshTotals stream_totals(const spillway::MeshTotals& totals);

/// A block in output coordinates and stream numbers, where `first_vertex` vertices come before it.
spillway::MeshBlock public_block(const MeshStreamHeader& header, MeshBlock&& block,
                                 std::uint64_t first_vertex);

/// A block of a stream whose coordinates are output coordinates, with short numbers. Throws
/// Error(kInvalidArgument) for corners or finalized vertices that have not come yet.
MeshBlock stream_block(const spillway::MeshBlock& block);

Report public_report(const StreamFigures& figures, const PointCounts& counts);

}  // namespace spillway::detail

#pragma once
// The proof behind check_mesh_stream, for one dimension: the steps of mesh_proof.h on a mesh that
// flows. What it proves, and why the open border is enough, is written in
// docs/algorithm-checker.md.

#include "formats/meshes/common/mesh_stream.h"
#include "stream/checker/checker.h"
#include "stream/checker/stream_block.h"

namespace spillway::checker {

/// Reads the stream to its end and writes the outcome into the report.
///
/// Blocks are read in batches; while a batch's blocks are examined, each by itself and by all
/// threads, the next batch is read. What a block leaves open then meets the open facets of earlier
/// ones, block by block. The report does not depend on the number of threads.
template <int D>
void prove_stream(MeshStreamReader& reader, const CheckerOptions& options, StreamTask task,
                  CheckReport& report);

}  // namespace spillway::checker

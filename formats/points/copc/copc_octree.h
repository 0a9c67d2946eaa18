#pragma once
// The octree of a COPC file: docs/formats-points.md ("COPC"). Source: COPC 1.0, https://copc.io.

#include <optional>
#include <vector>

#include "formats/bytes/input_bytes.h"
#include "formats/points/laz/chunk_table.h"
#include "src/geometry/box.h"

namespace spillway::formats {

/// Which nodes are wanted.
struct CopcSelection {
  std::optional<Box<3>> bounds;  ///< nodes that may have points in this closed box
  double resolution = 0;         ///< levels down to this spacing of points; 0: all
};

struct CopcNode {
  LazChunk chunk;  ///< that has its points
  Box<3> cube;     ///< in which they lie
};

/// The nodes that are wanted and have points, in file order, in a file that can be read from any
/// byte on (`source` is left somewhere). Reads the pages of the hierarchy that it needs. Throws
/// Failure for an octree that cannot be.
std::vector<CopcNode> select_copc_nodes(InputBytes& source, const LasHeader& las,
                                        const CopcSelection& selection);

}  // namespace spillway::formats

#pragma once

#include "stream/library/points/engine_points.h"
#include "stream/library/run.h"

namespace spillway::detail {

/// A run with a TriangulateOptions::resume_folder: goes on with what another process has left
/// there. A sink that cannot go on in the midst of the blocks gets them from a mesh in that folder,
/// when this is complete. Throws Error if the run cannot go on as a whole.
Report triangulate_resumably(Run& run, const EnginePoints& points);

}  // namespace spillway::detail

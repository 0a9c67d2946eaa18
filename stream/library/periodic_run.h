#pragma once

#include "stream/library/run.h"

namespace spillway::stream {

/// Throws Failure(kInvalidArgument) unless a periodic triangulation can be made as the options say,
/// and the sink holds it.
void check_periodic(const TriangulateOptions& options, const EngineSink& sink);

/// As triangulate() in this process, for options with a periodic box. Points have their input
/// index. Reads them once to guess a margin for their copies, and again to triangulate, with a
/// wider margin where that was too narrow.
Report triangulate_periodically(Run& run);

}  // namespace spillway::stream

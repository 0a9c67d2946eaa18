#pragma once

#include <string>

#include "stream/library/points/engine_points.h"
#include "stream/library/run.h"

namespace spillway::stream {

/// What tells a run with a TriangulateOptions::resume_folder from others. Throws Failure if it cannot
/// go on as a whole.
RunIdentity identity_of(const Run& run, const EnginePoints& points);

/// What users are told at the start of such a run, "" for nothing: that its points do not come
/// again.
std::string once_only_notice(const Run& run);

/// Goes on with what another process has left in the folder. A sink that cannot go on in the midst
/// of the blocks gets them from a mesh in that folder, when this is complete.
Report triangulate_resumably(Run& run);

/// Removes what a run has left in its folder, and what it has begun of its output, `output`, for
/// good. Throws Failure if the folder is of something else, is damaged, or if another process uses
/// it.
void discard_run(const std::string& folder, const std::string& output);

}  // namespace spillway::stream

#pragma once

#include <spillway/skipped_file.h>

#include <vector>

#include "tools/report/progress.h"

namespace spillway::command {

/// Names the files that --skip-broken left out, whatever is silenced. Returns the exit code of a
/// run that is complete but for these.
int tell_skipped(const std::vector<SkippedFile>& files, ProgressLine& progress);

}  // namespace spillway::command

#pragma once

#include <string>
#include <vector>

#include "tools/report/progress.h"

namespace spillway::command {

/// Throws UsageError if an output is called like tiles, which are not asked for.
void refuse_pattern(const std::string& output);

/// Warns of files that an earlier run may have left, which are called like the tiles of `output`.
void warn_of_other_tiles(const std::vector<std::string>& files, const std::string& output,
                         ProgressLine& progress);

}  // namespace spillway::command

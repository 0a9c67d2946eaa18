#pragma once

#include <vector>

#include "tools/batch/input_places.h"

namespace spillway::command {

/// For each job, whether the boxes of its inputs touch or overlap those of another one. They touch
/// where what is between them is as narrow as between points of one survey. Jobs that have a file
/// in common, or boxes that are mostly the same, are no neighbours: these are several jobs about
/// one area.
std::vector<bool> find_touching(const std::vector<std::vector<InputPlace>>& places);

}  // namespace spillway::command

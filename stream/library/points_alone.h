#pragma once

#include <spillway/report.h>

#include "stream/library/run.h"

namespace spillway::stream {

/// Gives all points to a sink that wants no simplices, and triangulates nothing. They are read once
/// if headers tell an extent that holds, or if the sink needs none, else twice. Throws Failure
/// (kDegenerateInput) if there are none.
Report take_points_alone(Run& run);

}  // namespace spillway::stream

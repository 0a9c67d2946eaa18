#pragma once

#include <spillway/convert.h>

#include "stream/library/context/run_watch.h"
#include "stream/library/points/engine_points.h"
#include "stream/library/points/point_file.h"

namespace spillway::stream {

/// Writes the points to a file that is to be sorted, and completes it: all points are dealt into
/// cells first, within the context's memory, then come cell by cell in the order of the tree that
/// divides them.
PointConversion sort_points(const RunPoints& points, PointFile& file, const Context& context,
                            RunWatch& watch);

}  // namespace spillway::stream

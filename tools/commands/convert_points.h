#pragma once

#include <vector>

#include "formats/disk/scratch_folder.h"
#include "stream/source/point_source.h"
#include "tools/commands/lattice_rounding.h"
#include "tools/options/point_output.h"
#include "tools/report/progress.h"

namespace spillway::detail {

/// Writes, as the phase that has begun, all points of the source as one file, as they come, and
/// says how many and what the format does not keep. LAS needs a lattice: points that have none are
/// rounded to one, and so are all if `choice` names one. Throws Error, and UsageError if the output
/// is of no point format.
void convert_points(PointSource& source, const PointOutput& output, const LatticeChoice& choice,
                    ScratchFolder& scratch, Progress& progress);

}  // namespace spillway::detail

#pragma once

#include <cstddef>
#include <vector>

#include "formats/points/las/records/las_metadata.h"

namespace spillway::formats {

/// Appends a record as it lies in a file, before the points or, if it is extended, behind them.
void append_vlr(const LasVlr& record, std::vector<std::byte>& out);

}  // namespace spillway::formats

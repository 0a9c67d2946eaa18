#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "formats/points/laz/chunk_table.h"

namespace spillway::formats {

/// The table of these chunks as it stands in the file: their sizes, and, if `with_counts`, their
/// numbers of points, which readers of chunks of one size know.
std::vector<std::byte> chunk_table_bytes(std::span<const LazChunk> chunks, bool with_counts);

}  // namespace spillway::formats

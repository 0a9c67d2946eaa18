#pragma once
// Whole records of LAZ chunks, of which Spillway reads only what it needs. Written from the
// description of the format, with the item versions from 2 on.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/points/las/laz_record.h"

namespace spillway::detail::testing {

/// The records of a chunk. Throws Error for item versions that it does not know.
std::vector<std::string> decode_laz_records(const LazChunkFormat& format,
                                            std::span<const std::byte> chunk, std::uint64_t count);

}  // namespace spillway::detail::testing

#pragma once

#include <cstddef>

#include "formats/points/las/laz_record.h"

namespace spillway::formats {

/// How much of each point is decoded; each level has what those before it have.
enum class LazDetail {
  kCoordinates,
  kFlags,    ///< also class, returns and flags
  kRecords,  ///< all bytes of the record
};

/// How many layers of a chunk of that format are decoded; they are its first ones. None if it is
/// pointwise.
std::size_t laz_wanted_layers(const LazChunkFormat& format, LazDetail detail);

}  // namespace spillway::formats

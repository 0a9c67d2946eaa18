#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/points/npy/npy_header.h"
#include "formats/points/rows/row_layout.h"

namespace spillway::formats {

/// An array as points.
struct NpyLayout {
  std::uint64_t count = 0;  ///< of points
  RowLayout row;
  std::vector<std::string> notices{};  ///< of what is not read
};

/// What the header of the file `name` tells. Fields, or columns, that are no coordinates become
/// attributes. Throws Failure that says what would be points otherwise.
NpyLayout npy_layout(const NpyHeader& header, const std::string& name);

/// Likewise of a structured array all fields of which are attributes. Throws Failure for any other.
NpyLayout npy_attributes(const NpyHeader& header, const std::string& name);

}  // namespace spillway::formats

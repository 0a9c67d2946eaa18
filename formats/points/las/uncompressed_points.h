#pragma once
// What lies where the header of a LAS file says that uncompressed points do.

#include <cstddef>
#include <span>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/points/las/las_header.h"

namespace spillway::formats {

struct PointSearch {
  bool salvage = false;  ///< the size of the file decides how many points there are
  std::string doubt{};   ///< what else speaks against the file, for messages
};

/// Goes to the first point and compares the number of points that the header tells with the size
/// of the file, where that is known. Throws BadInput if they do not fit; notices are of more than
/// the header counts. To be salvaged are all that are there: notices tell of the difference.
void find_points(InputBytes& source, LasHeader& header, const PointSearch& search);

/// Whether bytes behind the points are padding: zeros.
bool is_padding(std::span<const std::byte> bytes);

/// The place of the number of points in the header, for messages.
std::string place_of_count(const LasHeader& las);

}  // namespace spillway::formats

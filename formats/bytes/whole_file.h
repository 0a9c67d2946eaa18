#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/bytes/input_bytes.h"

namespace spillway::formats {

/// All that is left of a file.
std::vector<std::byte> read_whole(InputBytes& source);

/// The next `count` bytes; fewer if the file ends before. Memory is taken as bytes come, so that a
/// wrong count takes none.
std::vector<std::byte> read_up_to(InputBytes& source, std::uint64_t count);

}  // namespace spillway::formats

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace spillway::test {

/// The bytes of a stream of blocks (formats/blocks/block.h), that begin after so many others, with
/// checksums that fit: only so a reader looks at what damaged blocks hold.
std::string with_right_checksums(std::string_view bytes, std::size_t begin = 8);

/// The same stream, with no block compressed, so that damage meets the values.
std::string with_plain_blocks(std::string_view bytes, std::size_t begin = 8);

}  // namespace spillway::test

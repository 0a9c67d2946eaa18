#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/error.h"

namespace spillway::formats {

/// The simplices of a block in more than three dimensions, as append_corners() has them.
void append_simplices(std::vector<std::byte>& out, int dimension, std::uint32_t numbers,
                      std::span<const std::uint32_t> corners);

/// As read_corners() has them.
std::span<const std::byte> read_simplices(std::span<const std::byte> bytes, int dimension,
                                          std::uint32_t numbers, std::uint32_t simplices,
                                          std::vector<std::uint32_t>& corners,
                                          const FileSpot& where);

}  // namespace spillway::formats

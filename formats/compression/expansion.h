#pragma once
// How far compressed data may expand before it counts as made to fill the memory.

#include <cstdint>

#include "src/rooms.h"

namespace spillway::formats {

/// What nothing that is meant comes near to, in bytes for each compressed one.
inline constexpr std::uint64_t kMostExpansion = 2000;

/// Whether `size` bytes are more than 64 MiB and `most` (at least 1) times the compressed ones.
constexpr bool expands_too_far(std::uint64_t compressed, std::uint64_t size, std::uint64_t most) {
  constexpr std::uint64_t kFree = std::uint64_t{64} << 20;
  return size > kFree && size / most > compressed;
}

}  // namespace spillway::formats

#pragma once
// How far compressed data may expand before it counts as made to fill the memory.

#include <cstdint>

#include "src/rooms.h"

namespace spillway::formats {

/// The limit unless another one is given, in bytes for each compressed one. No table of points
/// comes near to it, and other programs write blocks of meshes of some megabytes only; but data
/// that is made for it, above all of xz, could fill the memory.
inline constexpr std::uint64_t kMostExpansion = 2000;

/// Whether `size` bytes are more than 64 MiB and `most` (at least 1) times the compressed ones.
constexpr bool expands_too_far(std::uint64_t compressed, std::uint64_t size, std::uint64_t most) {
  constexpr std::uint64_t kFree = std::uint64_t{64} << 20;
  return size > kFree && size / most > compressed;
}

}  // namespace spillway::formats

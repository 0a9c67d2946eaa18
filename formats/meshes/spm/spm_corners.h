#pragma once
// The simplices of a block as few bytes that are made fast: docs/formats-meshes.md ("spm").

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "src/error.h"

namespace spillway::formats {

/// Appends simplices of dimension+1 corners each, all of them below `numbers`. They come back
/// turned (orientation kept) so that the smallest corner is first, and sorted by it.
void append_corners(std::vector<std::byte>& out, int dimension, std::uint32_t numbers,
                    std::span<const std::uint32_t> corners);

/// Takes `simplices` simplices off the front of `bytes`, which hold nothing else, and returns the
/// bytes after them. Throws Failure, beginning with `where`, if bytes are missing or a corner is not
/// below `numbers`; allocates nothing that the bytes do not back.
std::span<const std::byte> read_corners(std::span<const std::byte> bytes, int dimension,
                                        std::uint32_t numbers, std::uint32_t simplices,
                                        std::vector<std::uint32_t>& corners, const FileSpot& where);

}  // namespace spillway::formats

#pragma once
// The tetrahedra of a block: docs/formats-meshes.md ("spm").

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/error.h"

namespace spillway::formats {

/// append_corners() of tetrahedra.
void append_tetrahedra(std::vector<std::byte>& out, std::uint32_t numbers,
                       std::span<const std::uint32_t> corners);

/// read_corners() of tetrahedra.
std::span<const std::byte> read_tetrahedra(std::span<const std::byte> bytes, std::uint32_t numbers,
                                           std::uint32_t tetrahedra,
                                           std::vector<std::uint32_t>& corners,
                                           const FileSpot& where);

}  // namespace spillway::formats

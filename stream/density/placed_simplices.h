#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "formats/meshes/common/mesh_stream.h"

namespace spillway::stream {

/// The corners of a simplex of up to three dimensions, by short numbers or what stands for them.
using SimplexCorners = std::array<std::uint32_t, 4>;
using SimplexOffsets = std::array<CornerOffset, 4>;

/// Calls visit(corners, offsets) for each simplex of a block, with its short numbers.
template <typename Visit>
void for_each_simplex(const MeshStreamBlock& block, int dimension, const Visit& visit) {
  const auto size = static_cast<std::size_t>(dimension) + 1;
  const std::size_t first_across = block.corners.size() - block.offsets.size();
  for (std::size_t c = 0; c < block.corners.size(); c += size) {
    SimplexCorners corners{};
    SimplexOffsets offsets{};
    for (std::size_t i = 0; i < size; ++i) {
      corners[i] = block.corners[c + i];
      if (c >= first_across) offsets[i] = block.offsets[c + i - first_across];
    }
    visit(corners, offsets);
  }
}

/// Where that copy of a vertex lies, in output coordinates like the vertex.
inline WorldPoint place_of_copy(const MeshStreamHeader& header, WorldPoint vertex,
                                CornerOffset offset) {
  for (int k = 0; k < header.dimension && offset != kNoOffset; ++k) {
    const int periods = periods_along(offset, k);
    if (periods != 0) vertex[k] += periods * header.periodic->period(k);
  }
  return vertex;
}

}  // namespace spillway::stream

#pragma once
// The content of a mesh block of Spillway's own stream: docs/formats-meshes.md ("spm").

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "src/error.h"

namespace spillway::formats {

/// How much is in a block.
struct SpmCounts {
  std::uint32_t vertices = 0;
  std::uint32_t numbers = 0;  ///< short numbers are below; at least `vertices`
  std::uint32_t simplices = 0;
};

/// Appends all of a block but `imported`, and returns how much that is. Throws Failure that says what
/// is wrong with the block, without the file's name.
SpmCounts append_spm_content(std::vector<std::byte>& out, const MeshStreamHeader& header,
                             const MeshStreamBlock& block);

/// Replaces all members of `block` but `imported` by what append_spm_content() wrote; simplices and
/// `finalized` are sorted. Coordinates are checked, and short numbers against those that the block
/// says it has. Throws Failure, beginning with `where`.
SpmCounts read_spm_content(std::span<const std::byte> content, const MeshStreamHeader& header,
                           const FileSpot& where, MeshStreamBlock& block);

}  // namespace spillway::formats

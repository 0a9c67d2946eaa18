#pragma once
// The bytes that a file of Spillway's own mesh stream is put together from, where not one writer
// makes them all: docs/formats-meshes.md ("spm").

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"

namespace spillway::formats {

/// The begin of a stream: magic and header.
std::vector<std::byte> spm_head(const MeshStreamHeader& header);

/// The end of a stream.
std::vector<std::byte> spm_trailer(const MeshTotals& totals);

/// Appends the stored block of imported vertices, of which there is at least one.
void append_spm_imported(std::vector<std::byte>& out, std::span<const std::uint64_t> imported);

/// Appends a mesh block, the block of its imported vertices before it. Throws Failure that says what
/// is wrong with the block, without a file's name.
void append_spm_block(std::vector<std::byte>& out, const MeshStreamHeader& header,
                      const MeshStreamBlock& block);

}  // namespace spillway::formats

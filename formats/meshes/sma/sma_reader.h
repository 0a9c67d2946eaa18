#pragma once

#include <memory>
#include <string_view>

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh_stream.h"

namespace spillway::formats {

/// The first line of an SMA file that Spillway wrote.
inline constexpr std::string_view kSmaNote = "# spillway mesh stream";

/// Whether a text begins as SMA does: with Spillway's own note, or comments and then a vertex. OBJ
/// may begin in the latter way, too.
bool looks_like_sma(std::string_view text);

/// Reads the ASCII streaming mesh of Isenburg and Lindstrom, vertices before the triangles that use
/// them. docs/formats-meshes.md ("SMA").
std::unique_ptr<MeshStreamReader> open_sma_reader(std::unique_ptr<InputBytes> source);

}  // namespace spillway::formats

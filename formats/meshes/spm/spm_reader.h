#pragma once

#include <memory>

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh_stream.h"

namespace spillway::formats {

/// Reads Spillway's own mesh stream.
std::unique_ptr<MeshStreamReader> open_spm_reader(std::unique_ptr<InputBytes> source);

}  // namespace spillway::formats

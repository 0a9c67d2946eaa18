#pragma once

#include <cstddef>
#include <memory>

#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_writer.h"

namespace spillway::formats {

inline constexpr std::size_t kVtuMemory = std::size_t{64} << 20;

/// Writes VTK's XML format for unstructured grids with appended raw data, as docs/formats-meshes.md
/// ("VTU") describes it. What goes with the points stands in arrays one after the other: of these
/// it holds `memory` bytes at most, and asks for the vertices again for the others.
std::unique_ptr<MeshWriter> open_vtu_writer(std::unique_ptr<OutputFile> file,
                                            const MeshFileHeader& header,
                                            std::size_t memory = kVtuMemory);

}  // namespace spillway::formats

#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_writer.h"

namespace spillway::formats {

/// Begins a LandXML 1.2 file of one TIN surface, with all digits of the coordinates. Throws Failure
/// if the header's coordinate system is none.
std::unique_ptr<MeshWriter> open_landxml_writer(std::unique_ptr<OutputFile> file,
                                                const MeshFileHeader& header);

}  // namespace spillway::formats

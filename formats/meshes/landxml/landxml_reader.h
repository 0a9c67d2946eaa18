#pragma once

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// Reads the one TIN surface of a LandXML file. The text is held in memory as a whole. Throws Failure
/// that names the file and the line.
Mesh read_landxml(InputBytes& source);

}  // namespace spillway::formats

#pragma once
// The XML header of VTU files, as docs/formats-meshes.md ("VTU") describes it.

#include <cstdint>
#include <optional>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/bytes/number_type.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::detail {

/// An array in the appended data.
struct VtuArray {
  NumberType type = NumberType::kFloat64;
  std::uint64_t components = 1;
  std::uint64_t offset = 0;  ///< from the first byte of the appended data
};

/// What precedes the appended data.
struct VtuHeader {
  MeshHeader mesh;  ///< dimension: what the file says; 0 if it says nothing
  VtuArray points;
  VtuArray connectivity;
  VtuArray offsets;
  VtuArray types;
  std::optional<VtuArray> input_index;
};

/// Reads a header, up to the first byte of the appended data. Throws Error that names the byte, for
/// what is malformed and for kinds of VTU that are not read.
VtuHeader read_vtu_header(InputBytes& source);

}  // namespace spillway::detail

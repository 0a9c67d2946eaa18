#include "formats/meshes/spm/spm_corners.h"

#include "formats/meshes/spm/spm_simplices.h"
#include "formats/meshes/spm/spm_tetrahedra.h"
#include "formats/meshes/spm/spm_triangles.h"

namespace spillway::formats {

void append_corners(std::vector<std::byte>& out, int dimension, std::uint32_t numbers,
                    std::span<const std::uint32_t> corners) {
  if (dimension == 2) {
    append_triangles(out, numbers, corners);
  } else if (dimension == 3) {
    append_tetrahedra(out, numbers, corners);
  } else {
    append_simplices(out, dimension, numbers, corners);
  }
}

std::span<const std::byte> read_corners(std::span<const std::byte> bytes, int dimension,
                                        std::uint32_t numbers, std::uint32_t simplices,
                                        std::vector<std::uint32_t>& corners,
                                        const FileSpot& where) {
  if (dimension == 2) return read_triangles(bytes, numbers, simplices, corners, where);
  if (dimension == 3) return read_tetrahedra(bytes, numbers, simplices, corners, where);
  return read_simplices(bytes, dimension, numbers, simplices, corners, where);
}

}  // namespace spillway::formats

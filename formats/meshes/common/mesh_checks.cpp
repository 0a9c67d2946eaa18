#include "formats/meshes/common/mesh_checks.h"

#include <fmt/format.h>

#include "src/error.h"

namespace spillway::formats {

void fail_for_point_cloud(const std::string& file, std::string_view format) {
  throw BadInput(file,
                 fmt::format("there are no faces or tetrahedra: this is a cloud of points, and "
                             "Spillway does not read points from {}; convert it to LAS, text "
                             "or npy (with PDAL or CloudCompare, say)",
                             format));
}

}  // namespace spillway::formats

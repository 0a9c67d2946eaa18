#include "formats/meshes/common/mesh_checks.h"

#include <fmt/format.h>

#include "src/error.h"

namespace spillway::detail {

bool is_spillway_note(std::string_view comment) { return comment.starts_with("spillway "); }

void fail_for_point_cloud(const std::string& file, std::string_view format) {
  throw Error(fmt::format(
      "{}: there are no faces or tetrahedra: this is a cloud of points, and Spillway does not read "
      "points from {}; convert it to LAS, text or npy (with PDAL or CloudCompare, say)",
      file, format));
}

}  // namespace spillway::detail

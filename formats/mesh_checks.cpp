#include "formats/mesh_checks.h"

#include <fmt/format.h>

#include "src/error.h"

namespace spillway {

bool is_spillway_note(std::string_view comment) { return comment.starts_with("spillway "); }

void fail_for_point_cloud(const std::string& file) {
  throw Error(
      fmt::format("{}: there are no faces or tetrahedra: this is a cloud of points, not a "
                  "mesh; triangulate it first",
                  file));
}

}  // namespace spillway

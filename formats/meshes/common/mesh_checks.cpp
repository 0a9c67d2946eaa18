#include "formats/meshes/common/mesh_checks.h"

#include <fmt/format.h>

#include <cctype>

#include "src/error.h"

namespace spillway::detail {

bool is_spillway_note(std::string_view comment) { return comment.starts_with("spillway "); }

bool begins_with_word(std::string_view first_bytes, std::string_view word) {
  return first_bytes.starts_with(word) &&
         (first_bytes.size() == word.size() ||
          std::isspace(static_cast<unsigned char>(first_bytes[word.size()])) != 0);
}

void fail_for_point_cloud(const std::string& file, std::string_view format) {
  throw BadInput(file,
                 fmt::format("there are no faces or tetrahedra: this is a cloud of points, and "
                             "Spillway does not read points from {}; convert it to LAS, text "
                             "or npy (with PDAL or CloudCompare, say)",
                             format));
}

}  // namespace spillway::detail

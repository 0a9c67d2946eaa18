#include "formats/meshes/off/off_kind.h"

namespace spillway::formats {

std::optional<OffKind> off_kind(std::string_view name) {
  const auto take = [&name](std::string_view part) {
    const bool is_next = name.starts_with(part);
    if (is_next) name.remove_prefix(part.size());
    return is_next;
  };
  OffKind kind;
  kind.has_texture = take("ST");
  kind.has_colours = take("C");
  kind.has_normals = take("N");
  kind.is_homogeneous = take("4");
  kind.has_dimension = take("n");
  if (name != "OFF") return std::nullopt;
  return kind;
}

std::optional<OffKind> off_kind_of_text(std::string_view first_bytes) {
  return off_kind(first_bytes.substr(0, first_bytes.find_first_of(" \t\r\n#")));
}

}  // namespace spillway::formats

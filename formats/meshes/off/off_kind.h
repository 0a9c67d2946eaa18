#pragma once
// The first word of OFF files, which tells what stands in the line of a vertex. Source: Geomview
// manual, "OFF Files".

#include <optional>
#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// A kind of OFF file.
struct OffKind {
  bool has_texture = false;     ///< ST: two more numbers
  bool has_colours = false;     ///< C: three or four
  bool has_normals = false;     ///< N: three
  bool is_homogeneous = false;  ///< 4: a fourth coordinate
  bool has_dimension = false;   ///< n: as many coordinates as its second line says

  /// The fewest and the most numbers that follow x, y, z.
  [[nodiscard]] int fewest_extras() const {
    return (has_texture ? 2 : 0) + (has_colours ? 3 : 0) + (has_normals ? 3 : 0);
  }
  [[nodiscard]] int most_extras() const { return fewest_extras() + (has_colours ? 1 : 0); }
};

/// The kind of that name, as [ST][C][N][4][n]OFF; nothing if it is none.
std::optional<OffKind> off_kind(std::string_view name);

/// The kind that a file's first word names.
std::optional<OffKind> off_kind_of_text(std::string_view first_bytes);

}  // namespace spillway::formats

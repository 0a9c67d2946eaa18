#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/ply/ply_header.h"
#include "formats/points/rows/row_layout.h"

namespace spillway::formats {

/// A PLY file as points: those are its vertices.
struct PlyCloud {
  PlyHeader header;
  std::size_t vertices = 0;  ///< place of the element
  RowLayout row;             ///< of the numbers of a vertex; lists are left out
  std::string crs;
  std::vector<std::string> notices;  ///< of what is not read

  [[nodiscard]] const PlyElement& vertex() const { return header.elements[vertices]; }

  /// Bytes before the first vertex, if that is known and all vertices have the same size; nothing
  /// for text, and where there are lists.
  std::optional<std::uint64_t> bytes_before;
  /// Bytes after the last vertex; likewise.
  std::optional<std::uint64_t> bytes_behind;

  /// Fewest bytes that a vertex takes.
  [[nodiscard]] std::uint64_t smallest_vertex() const;
};

/// What the header of the file `name` tells. Scalar properties of vertices that are no coordinates
/// become attributes. Throws Failure for a mesh, and where there are no x and y.
PlyCloud ply_cloud(PlyHeader header, const std::string& name);

}  // namespace spillway::formats

#pragma once

#include <spillway/periodic.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/meshes/common/corner_offset.h"
#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/attributes/further_coordinates.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/lattice.h"

namespace spillway::formats {

/// Vertices one after another whose numbers in a larger mesh count up by one.
struct IdRange {
  std::uint64_t first = 0;  ///< number of the first
  std::uint64_t count = 0;  ///< of vertices
};

/// What a mesh file says about itself.
struct MeshFileHeader {
  int dimension = 2;             ///< 2: triangles, 3: tetrahedra, up to 6
  std::uint64_t vertices = 0;    ///< number of vertices
  std::uint64_t simplices = 0;   ///< number of finite simplices
  bool has_input_index = false;  ///< each vertex carries its index in the input
  std::optional<IntegerLattice>
      lattice;      ///< set if every coordinate is lattice.to_world of an integer
  std::string crs;  ///< coordinate system as WKT or PROJ text, empty if unknown
  /// Of a part of a larger mesh: which of its vertices these are. Only PLY and VTU have a place for
  /// them; readers pass over it.
  std::optional<std::vector<IdRange>> global_ids{};
  AttributeLayout attributes{};  ///< that each vertex carries; first its coordinates beyond z
  /// Whether all numbers of the attributes `red`, `green` and `blue` are known to be below 256:
  /// then they are bytes, though they may be of 16 bits, as LAS has no others.
  bool colours_are_bytes = false;
  std::optional<PeriodicBox> periodic{};  ///< the mesh repeats with it; in output coordinates
};

/// A whole mesh in memory, as `check`, `info` and `convert` read it.
struct Mesh {
  MeshFileHeader header;
  std::vector<WorldPoint> vertices;        ///< output coordinates; z is 0 where the file has none
  std::vector<std::uint64_t> corners;      ///< dimension+1 vertex numbers a simplex, in file order
  std::vector<std::uint64_t> input_index;  ///< one a vertex if header.has_input_index, else empty
  std::vector<std::byte> attributes{};     ///< of all vertices: a record each
  std::vector<CornerOffset> offsets{};     ///< of `corners`, of a periodic mesh; else empty
  std::string_view format{};               ///< name of the format of the file that was read
  /// What was made of the file, or left out, that it does not say itself.
  std::vector<std::string> notices{};

  [[nodiscard]] std::size_t corners_per_simplex() const { return header.dimension + 1; }
  /// All coordinates of a vertex in output coordinates.
  template <int D>
  [[nodiscard]] Point<D> vertex(std::size_t v) const {
    const std::size_t record_size = header.attributes.record_size();
    return coordinates_of<D>(vertices[v], D > kOwnAxes ? &attributes[v * record_size] : nullptr);
  }
};

}  // namespace spillway::formats

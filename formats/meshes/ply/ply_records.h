#pragma once
// What a PLY file is made of, for who writes it: docs/formats-meshes.md ("PLY").

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/vertex_records.h"

namespace spillway::formats {

/// The header, up to the first value. Throws Failure that names the file `name` for more vertices
/// than PLY can number.
std::string ply_header_text(const MeshFileHeader& header, bool ascii, const std::string& name);

/// The attributes that PLY has for those of vertices: colours of 8 bits, as other programs expect
/// them.
AttributeLayout ply_vertex_layout(const AttributeLayout& attributes);

/// Makes their records. Throws Failure that names the file `name` for an integer that PLY does not
/// hold.
VertexRecords ply_vertex_records(const MeshFileHeader& header, const std::string& name);

/// A number that goes with a vertex, as the double that PLY has for it. Throws Failure that names the
/// file `name` if it is too large for that.
double ply_index(std::uint64_t index, const std::string& name);

/// Bytes of a vertex with `indices` such numbers and no attributes, and of a simplex, in binary.
constexpr std::size_t ply_vertex_size(std::size_t indices) {
  return (3 + indices) * sizeof(double);
}
constexpr std::size_t ply_simplex_size(int dimension) {
  return 1 + (dimension + 1) * sizeof(std::uint32_t);
}

/// Puts down a vertex, with the record of its attributes, or a simplex in binary and returns where
/// it ends.
std::byte* put_ply_vertex(std::byte* at, const WorldPoint& vertex, std::span<const double> indices,
                          std::span<const std::byte> record);
std::byte* put_ply_simplex(std::byte* at, std::span<const std::uint64_t> corners);

}  // namespace spillway::formats

#pragma once
// What a PLY file is made of, for who writes it: docs/formats-meshes.md ("PLY").

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "formats/meshes/common/mesh.h"

namespace spillway::detail {

/// The header, up to the first value. Throws Error that names the file `name` for more vertices
/// than PLY can number.
std::string ply_header_text(const MeshHeader& header, bool ascii, const std::string& name);

/// A number that goes with a vertex, as the double that PLY has for it. Throws Error that names the
/// file `name` if it is too large for that.
double ply_index(std::uint64_t index, const std::string& name);

/// Bytes of a vertex with `indices` such numbers, and of a simplex, in binary.
constexpr std::size_t ply_vertex_size(std::size_t indices) {
  return (3 + indices) * sizeof(double);
}
constexpr std::size_t ply_simplex_size(int dimension) {
  return 1 + (dimension + 1) * sizeof(std::uint32_t);
}

/// Puts down a vertex or a simplex in binary and returns where it ends.
std::byte* put_ply_vertex(std::byte* at, const WorldPoint& vertex, std::span<const double> indices);
std::byte* put_ply_simplex(std::byte* at, std::span<const std::uint64_t> corners);

}  // namespace spillway::detail

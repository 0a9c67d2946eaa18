#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/vertex_records.h"

namespace spillway::formats {

/// How a format is laid out whose file is a header, then all vertices and then all simplices, each
/// kind of one size: several processes can write to one such file, each record at its place.
/// `name` is that of the file, for messages.
struct MeshRecords {
  /// All before the first vertex. Throws Failure for a mesh that the format cannot hold.
  std::string (*header)(const MeshFileHeader& header, const std::string& name);
  /// What makes the records of attributes that put_vertex() is given.
  VertexRecords (*attributes)(const MeshFileHeader& header, const std::string& name);
  std::size_t (*vertex_size)(const MeshFileHeader& header);
  std::size_t (*simplex_size)(int dimension);
  /// Puts down a vertex with its record, or a simplex, and returns where it ends. Throws Failure for
  /// an index that is too large.
  std::byte* (*put_vertex)(std::byte* at, const WorldPoint& vertex,
                           const std::optional<std::uint64_t>& input_index,
                           std::span<const std::byte> record, const std::string& name);
  std::byte* (*put_simplex)(std::byte* at, std::span<const std::uint64_t> corners);
};

}  // namespace spillway::formats

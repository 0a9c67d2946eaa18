#include "formats/meshes/ply/ply_records.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "formats/bytes/bytes.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/points/attributes/unique_names.h"
#include "formats/points/ply/ply_properties.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::uint64_t kMostInInt = std::uint64_t{1} << 31;
constexpr std::uint64_t kMostInUint = std::uint64_t{1} << 32;

/// Input indices are doubles, as PLY has no 64-bit integers; up to here they are exact.
constexpr std::uint64_t kLargestIndex = std::uint64_t{1} << 53;

/// Names that no attribute has.
constexpr std::array<const char*, 5> kOwnProperties = {"x", "y", "z", "input_index", "global_id"};

std::string index_property(std::string_view property) {
  return fmt::format(
      "comment {0} is a whole number; PLY has no 64-bit integer type\n"
      "property double {0}\n",
      property);
}

template <typename T>
std::byte* put(std::byte* at, const T& value) {
  store(at, value);
  return at + sizeof(T);
}

}  // namespace

std::string ply_header_text(const MeshFileHeader& header, bool ascii, const std::string& name) {
  if (header.vertices > kMostInUint) {
    throw CannotWrite(
        name, fmt::format("PLY numbers at most {} vertices; choose vtu or npy", kMostInUint),
        ErrorCode::kTooLarge);
  }
  std::string text = fmt::format("ply\nformat {} 1.0\n", ascii ? "ascii" : "binary_little_endian");
  for (const std::string& note : mesh_notes(header)) text += "comment " + note + '\n';
  text +=
      fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
                  header.vertices);
  if (header.has_input_index) text += index_property("input_index");
  if (header.global_ids) text += index_property("global_id");
  UniqueNames names({kOwnProperties.begin(), kOwnProperties.end()});
  text += ply_property_lines(ply_vertex_layout(header.attributes), names);
  return text + fmt::format("element {} {}\nproperty list uchar {} vertex_indices\nend_header\n",
                            header.dimension == 2 ? "face" : "tetrahedron", header.simplices,
                            header.vertices > kMostInInt ? "uint" : "int");
}

AttributeLayout ply_vertex_layout(const AttributeLayout& attributes) {
  return as_ply(with_byte_colours(attributes));
}

VertexRecords ply_vertex_records(const MeshFileHeader& header, const std::string& name) {
  return {header, ply_vertex_layout(header.attributes),
          PlyIntegerCheck(header.attributes, "vertex", name)};
}

double ply_index(std::uint64_t index, const std::string& name) {
  if (index > kLargestIndex) {
    throw CannotWrite(name,
                      fmt::format("PLY cannot hold the input index {}; choose vtu or npy", index),
                      ErrorCode::kTooLarge);
  }
  return static_cast<double>(index);
}

std::byte* put_ply_vertex(std::byte* at, const WorldPoint& vertex, std::span<const double> indices,
                          std::span<const std::byte> record) {
  for (const double coordinate : vertex) at = put(at, coordinate);
  for (const double index : indices) at = put(at, index);
  return std::ranges::copy(record, at).out;
}

std::byte* put_ply_simplex(std::byte* at, std::span<const std::uint64_t> corners) {
  at = put(at, static_cast<std::uint8_t>(corners.size()));
  for (const std::uint64_t corner : corners) at = put(at, static_cast<std::uint32_t>(corner));
  return at;
}

}  // namespace spillway::formats

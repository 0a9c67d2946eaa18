#include "formats/meshes/common/checked_mesh_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "formats/meshes/common/periodic_mesh.h"
#include "src/error.h"

namespace spillway::formats {

CheckedMeshWriter::CheckedMeshWriter(MeshFileHeader header, std::string name)
    : header_(std::move(header)), name_(std::move(name)) {
  if (!header_.global_ids) return;
  std::uint64_t ids = 0;
  for (const IdRange& run : *header_.global_ids) ids += run.count;
  if (ids != header_.vertices) {
    fail(fmt::format("{} vertices were promised, but {} ids for them", header_.vertices, ids));
  }
}

void CheckedMeshWriter::write_vertices(std::span<const WorldPoint> vertices,
                                       std::span<const std::uint64_t> input_index,
                                       std::span<const std::byte> attributes) {
  if (vertices.size() > header_.vertices - vertices_) {
    fail(fmt::format("more than the {} vertices that were promised came", header_.vertices));
  }
  if (input_index.size() != (header_.has_input_index ? vertices.size() : 0)) {
    fail(
        fmt::format("{} vertices came with {} input indices", vertices.size(), input_index.size()));
  }
  const std::size_t record = header_.attributes.record_size();
  if (attributes.size() != vertices.size() * record) {
    fail(fmt::format("{} vertices came with {} bytes of attributes, but each has {}",
                     vertices.size(), attributes.size(), record));
  }
  put_vertices(vertices, input_index, attributes);
  vertices_ += vertices.size();
}

bool CheckedMeshWriter::begin_vertices_again() {
  if (vertices_ != header_.vertices || !wants_vertices_again()) return false;
  vertices_ = 0;
  return true;
}

void CheckedMeshWriter::write_simplices(std::span<const std::uint64_t> corners) {
  if (vertices_ != header_.vertices) {
    fail(fmt::format("{} vertices were promised, but {} came before the first simplex",
                     header_.vertices, vertices_));
  }
  check_vertices_again();
  const std::size_t count = corners.size() / corners_per_simplex();
  if (corners.size() % corners_per_simplex() != 0 || count > header_.simplices - simplices_) {
    fail(fmt::format("{} corners came where {} simplices of {} were left to write", corners.size(),
                     header_.simplices - simplices_, corners_per_simplex()));
  }
  const auto largest = std::max_element(corners.begin(), corners.end());
  if (largest != corners.end() && *largest >= header_.vertices) {
    fail(fmt::format("simplex {} has vertex {}, but there are only {} vertices",
                     simplices_ + (largest - corners.begin()) / corners_per_simplex(), *largest,
                     header_.vertices));
  }
  put_simplices(corners);
  simplices_ += count;
}

void CheckedMeshWriter::write_offsets(std::uint64_t first_corner,
                                      std::span<const CornerOffset> offsets) {
  if (!header_.periodic) fail("offsets of corners came for a mesh that is not periodic");
  const std::size_t corners = corners_per_simplex();
  const std::uint64_t written = simplices_ * corners;
  if (first_corner < offsets_ || first_corner > written ||
      offsets.size() > written - first_corner || first_corner % corners != 0 ||
      offsets.size() % corners != 0) {
    fail(
        fmt::format("offsets of {} corners came from corner {} on, where {} corners were written "
                    "and those before {} had theirs",
                    offsets.size(), first_corner, written, offsets_));
  }
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    if (is_offset(offsets[i], *header_.periodic) && (i % corners != 0 || offsets[i] == kNoOffset)) {
      continue;
    }
    fail(fmt::format("corner {} has an offset that it cannot have", first_corner + i));
  }
  offsets_ = first_corner + offsets.size();
  put_offsets(first_corner, offsets);
}

void CheckedMeshWriter::finish() {
  if (vertices_ != header_.vertices || simplices_ != header_.simplices) {
    fail(fmt::format("{} vertices and {} simplices were promised, but {} and {} came",
                     header_.vertices, header_.simplices, vertices_, simplices_));
  }
  check_vertices_again();
  complete();
}

void CheckedMeshWriter::check_vertices_again() const {
  if (wants_vertices_again()) fail("the vertices did not come again, as was asked for");
}

void CheckedMeshWriter::fail(const std::string& what, ErrorCode code) const {
  throw CannotWrite(name_, what, code);
}

}  // namespace spillway::formats

#include "formats/meshes/ply/ply_writer.h"

#include <array>
#include <optional>
#include <utility>

#include "formats/bytes/buffered_output.h"
#include "formats/meshes/common/checked_mesh_writer.h"
#include "formats/meshes/common/global_ids.h"
#include "formats/meshes/common/mesh_text.h"
#include "formats/meshes/ply/ply_records.h"

namespace spillway::formats {
namespace {

class PlyWriter : public CheckedMeshWriter {
 public:
  PlyWriter(std::unique_ptr<OutputFile> file, const MeshFileHeader& header, bool ascii)
      : CheckedMeshWriter(header, file->name()),
        output_(std::move(file)),
        ascii_(ascii),
        records_(ply_vertex_records(header, output_.name())) {
    output_.append(ply_header_text(header, ascii, output_.name()));
    if (this->header().global_ids) ids_.emplace(*this->header().global_ids);
  }

 private:
  void put_vertices(std::span<const WorldPoint> vertices,
                    std::span<const std::uint64_t> input_index,
                    std::span<const std::byte> attributes) override {
    const std::span<const std::byte> records = records_.convert(attributes, vertices_);
    vertices_ += vertices.size();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      std::size_t count = 0;
      std::array<double, 2> indices;
      if (header().has_input_index) indices[count++] = ply_index(input_index[i], output_.name());
      if (ids_) indices[count++] = ply_index(ids_->next(), output_.name());
      put_vertex(vertices[i], std::span(indices).first(count),
                 records.subspan(i * records_.size(), records_.size()));
    }
  }

  void put_vertex(const WorldPoint& vertex, std::span<const double> indices,
                  std::span<const std::byte> record) {
    if (ascii_) {
      append_coordinates(output_, "", vertex);
      for (const double index : indices) {
        append_number(output_, " ", static_cast<std::uint64_t>(index));
      }
      append_numbers(output_, records_.layout(), record);
      append_line_end(output_);
    } else {
      std::byte* const at = output_.reserve(ply_vertex_size(indices.size()) + record.size());
      output_.advance_to(put_ply_vertex(at, vertex, indices, record));
    }
  }

  void put_simplices(std::span<const std::uint64_t> corners) override {
    const std::size_t count = corners_per_simplex();
    for (; !corners.empty(); corners = corners.subspan(count)) {
      const std::span<const std::uint64_t> simplex = corners.first(count);
      if (ascii_) {
        append_simplex(output_, count == 3 ? "3" : "4", simplex, 0);
      } else {
        std::byte* const at = output_.reserve(ply_simplex_size(header().dimension));
        output_.advance_to(put_ply_simplex(at, simplex));
      }
    }
  }

  void complete() override { output_.commit(); }

  BufferedOutput output_;
  bool ascii_;
  VertexRecords records_;
  std::uint64_t vertices_ = 0;  // written so far
  std::optional<GlobalIds> ids_;
};

}  // namespace

std::unique_ptr<MeshWriter> open_ply_writer(std::unique_ptr<OutputFile> file,
                                            const MeshFileHeader& header, bool ascii) {
  return std::make_unique<PlyWriter>(std::move(file), header, ascii);
}

}  // namespace spillway::formats

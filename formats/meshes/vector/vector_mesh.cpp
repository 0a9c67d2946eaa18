#include "formats/meshes/vector/vector_mesh.h"

#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "formats/gdal/gdal.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/meshes/common/triangle_stream_writer.h"
#include "formats/meshes/common/vertex_joiner.h"
#include "formats/vectors/vector_file.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr const char* kNote = "SPILLWAY_LATTICE";

VectorLayerOptions layer_options(const std::string& path, const MeshStreamHeader& header) {
  VectorLayerOptions options;
  options.path = path;
  options.crs = header.crs;
  MeshFileHeader notes;
  notes.lattice = header.lattice;
  if (header.lattice) options.metadata[kNote] = mesh_notes(notes).back();
  return options;
}

class VectorMeshWriter : public TriangleStreamWriter {
 public:
  VectorMeshWriter(const std::string& path, const VectorFormat& format,
                   const MeshStreamHeader& header)
      : TriangleStreamWriter(header, path), file_(format, layer_options(path, header)) {}

  [[nodiscard]] std::uint64_t bytes_written() const override { return file_.bytes(); }

 private:
  void put_triangle(const std::array<WorldPoint, 3>& corners) override {
    file_.layer().add_triangle(corners);
  }
  void complete() override { file_.finish(); }

  VectorFile file_;
};

}  // namespace

std::unique_ptr<MeshStreamWriter> open_vector_mesh_writer(const std::string& path,
                                                          const VectorFormat& format,
                                                          const MeshStreamHeader& header) {
  return std::make_unique<VectorMeshWriter>(path, format, header);
}

Mesh read_vector_mesh(const std::string& path) {
  const std::unique_ptr<TriangleLayer> layer = gdal().open_layer(path);
  Mesh mesh;
  mesh.header.crs = layer->crs();
  if (!read_mesh_note(layer->metadata(kNote), mesh.header)) {
    throw Failure(fmt::format("cannot read {}: the layer's metadata {} holds no lattice: three "
                              "positive scales, three offsets",
                              path, kNote),
                  ErrorCode::kBadInput, {.file = path});
  }
  VertexJoiner joiner(mesh);
  std::array<WorldPoint, 3> corners;
  while (layer->next(corners)) {
    for (const WorldPoint& corner : corners) joiner.add(corner);
  }
  joiner.finish();
  return mesh;
}

}  // namespace spillway::formats

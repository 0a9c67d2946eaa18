#include "formats/meshes/obj/obj_writer.h"

#include <utility>

#include "formats/bytes/buffered_output.h"
#include "formats/meshes/common/checked_mesh_writer.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/meshes/common/mesh_text.h"

namespace spillway::formats {
namespace {

class ObjWriter : public CheckedMeshWriter {
 public:
  ObjWriter(std::unique_ptr<OutputFile> file, const MeshFileHeader& header)
      : CheckedMeshWriter(header, file->name()), output_(std::move(file)) {
    for (const std::string& note : mesh_notes(header)) output_.append("# " + note + '\n');
  }

 private:
  void put_vertices(std::span<const WorldPoint> vertices,
                    std::span<const std::uint64_t> /*input_index*/,
                    std::span<const std::byte> /*attributes*/) override {
    for (const WorldPoint& vertex : vertices) {
      append_coordinates(output_, "v ", vertex);
      append_line_end(output_);
    }
  }

  void put_simplices(std::span<const std::uint64_t> corners) override {
    for (; !corners.empty(); corners = corners.subspan(3)) {
      append_simplex(output_, "f", corners.first(3), 1);
    }
  }

  void complete() override { output_.commit(); }

  BufferedOutput output_;
};

}  // namespace

std::unique_ptr<MeshWriter> open_obj_writer(std::unique_ptr<OutputFile> file,
                                            const MeshFileHeader& header) {
  return std::make_unique<ObjWriter>(std::move(file), header);
}

}  // namespace spillway::formats

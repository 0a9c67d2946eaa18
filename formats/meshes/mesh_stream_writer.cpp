#include "formats/meshes/mesh_stream_writer.h"

#include <utility>

#include "formats/meshes/create_mesh.h"
#include "formats/meshes/sma/sma_writer.h"
#include "formats/meshes/spm/spm_writer.h"
#include "formats/meshes/spooled_mesh_writer.h"
#include "formats/meshes/stl/stl_writer.h"
#include "formats/meshes/vector/vector_mesh.h"

namespace spillway::detail {

std::unique_ptr<MeshStreamWriter> open_mesh_stream_writer(FileSystem& files,
                                                          const std::string& path,
                                                          MeshFormat format,
                                                          const MeshStreamHeader& header,
                                                          ScratchFolder& scratch) {
  MeshFiles created =
      create_mesh_files(files, path, format, header.dimension, header.has_input_index);
  switch (format) {
    case MeshFormat::kSpm:
      return open_spm_writer(std::move(created.main), header);
    case MeshFormat::kSma:
      return open_sma_writer(std::move(created.main), header);
    case MeshFormat::kStl:
      return open_stl_writer(std::move(created.main), header);
    case MeshFormat::kGpkg:
    case MeshFormat::kShp:
      return open_vector_mesh_writer(path, format, header);
    default:
      return open_spooled_mesh_writer(std::move(created), header, scratch);
  }
}

}  // namespace spillway::detail

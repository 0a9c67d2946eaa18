#include "formats/meshes/mesh_stream_writer.h"

#include <utility>

#include "formats/meshes/create_mesh.h"
#include "formats/meshes/spooled_mesh_writer.h"

namespace spillway::formats {

std::unique_ptr<MeshStreamWriter> open_mesh_stream_writer(FileSystem& files,
                                                          const std::string& path,
                                                          const MeshFormat& format,
                                                          const MeshStreamHeader& header,
                                                          ScratchFolder& scratch) {
  MeshFiles created = create_mesh_files(files, path, format, contents_of(header));
  if (format.open_block_writer != nullptr) {
    return format.open_block_writer(std::move(created), header);
  }
  return open_spooled_mesh_writer(std::move(created), header, scratch);
}

}  // namespace spillway::formats

#include "stream/library/file_mesh.h"

#include <utility>

#include "formats/disk/file_system.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/mesh_stream_writer.h"
#include "src/error.h"
#include "stream/library/public_values.h"

namespace spillway::detail {

FileMesh::FileMesh(std::string path, const MeshOptions& options, const Context& context)
    : path_(std::move(path)),
      format_(mesh_format(path_, options.format)),
      scratch_(make_scratch_folder(context.options().scratch_folder, context.scratch_limit())) {}

MeshStreamWriter& FileMesh::open(const MeshStreamHeader& header) {
  writer_ = open_mesh_stream_writer(disk(), path_, format_, header, *scratch_);
  return *writer_;
}

MeshStreamWriter& FileMesh::begun() {
  if (!writer_) throw InvalidArgument(path_ + ": blocks of a mesh come between begin and finish");
  return *writer_;
}

void FileMesh::begin(const spillway::MeshHeader& header) { open(stream_header(header)); }

void FileMesh::write(const spillway::MeshBlock& block) { begun().write(stream_block(block)); }

void FileMesh::finish(const spillway::MeshTotals& totals) {
  begun().finish(stream_totals(totals));
  writer_.reset();
}

}  // namespace spillway::detail

namespace spillway {

std::unique_ptr<MeshSink> open_mesh(const std::string& path, const MeshOptions& options,
                                    const Context& context) {
  return std::make_unique<detail::FileMesh>(path, options, context);
}

}  // namespace spillway

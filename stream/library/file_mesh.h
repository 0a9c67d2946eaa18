#pragma once

#include <spillway/mesh.h>

#include <memory>
#include <string>

#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/mesh_format.h"
#include "formats/meshes/common/mesh_stream.h"

namespace spillway::detail {

/// A mesh file for a program. Inside of the library the engine writes to it as to any file.
class FileMesh final : public spillway::MeshSink {
 public:
  /// Throws Error(kInvalidArgument) if neither path nor options name a format.
  FileMesh(std::string path, const MeshOptions& options, const Context& context);

  void begin(const spillway::MeshHeader& header) override;
  void write(const spillway::MeshBlock& block) override;
  void finish(const spillway::MeshTotals& totals) override;

  /// Begins the file for the engine, which may map coordinates by a lattice.
  MeshStreamWriter& open(const MeshStreamHeader& header);

 private:
  /// Throws Error(kInvalidArgument) if the file has not been begun, or is finished.
  MeshStreamWriter& begun();

  std::string path_;
  const MeshFormat& format_;
  std::unique_ptr<ScratchFolder> scratch_;
  std::unique_ptr<MeshStreamWriter> writer_;
};

}  // namespace spillway::detail

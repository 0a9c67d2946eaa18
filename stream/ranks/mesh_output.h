#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "formats/disk/file_system.h"
#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/mesh_format.h"
#include "formats/meshes/spool/mesh_spool.h"
#include "src/distributed/ranks.h"
#include "stream/library/meshes/mesh_file.h"
#include "stream/ranks/rank_pipeline.h"

namespace spillway::ranks {

/// The output of triangulate_over_ranks(). One of:
/// - spm and formats with records (binary PLY) in a file: all ranks write to it, each at its
///   places;
/// - one file otherwise: rank 0 writes what the others send, some MiB at a time;
/// - parts: each rank has a file of its own, a mesh that stands for itself, in which vertices of
///   other ranks are repeated; for VTU also an index NAME.pvtu (docs/formats-meshes.md, "Parts").
/// Nothing has its final name before all ranks have succeeded.
class MeshOutput {
 public:
  virtual ~MeshOutput() = default;
  MeshOutput(const MeshOutput&) = delete;
  MeshOutput& operator=(const MeshOutput&) = delete;

  /// Takes the blocks of this rank's own tiles, numbered from 0 on; not to be finished. Not
  /// collective.
  [[nodiscard]] MeshStreamWriter& writer() { return spool_; }

  /// Completes the output and returns its bytes, of all files, at all ranks. Uses up `mesh.merged`.
  /// Collective. Throws Failure at one rank, while the others wait to be ended.
  virtual std::uint64_t finish(RankMesh& mesh) = 0;

 protected:
  MeshOutput(const MeshStreamHeader& header, const std::string& name, ScratchFolder& scratch);

  MeshSpool spool_;
};

/// Ends a spool that has got the blocks of this rank's own tiles.
void finish_own_blocks(MeshSpool& spool, const RankMesh& mesh);

/// Creates the output's files, still under temporary names. Rank 0's header counts where they
/// differ. `scratch` and `ranks` must outlive the output. Collective. Throws Failure or
/// InvalidArgument at rank 0 if that cannot be done or the format does not hold the mesh, while the
/// others wait to be ended.
std::unique_ptr<MeshOutput> open_mesh_output(FileSystem& files, const MeshTarget& target,
                                             const MeshStreamHeader& header, ScratchFolder& scratch,
                                             const distributed::Ranks& ranks);

/// The blocks of all ranks, which rank 0 gives to its `writer`; others have none.
std::unique_ptr<MeshOutput> collect_mesh(const std::string& name, const MeshStreamHeader& header,
                                         ScratchFolder& scratch, const distributed::Ranks& ranks,
                                         std::unique_ptr<MeshStreamWriter> writer);

}  // namespace spillway::ranks

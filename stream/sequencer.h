#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

#include "formats/mesh_stream.h"
#include "stream/open_facets.h"
#include "stream/settle.h"
#include "stream/stage_times.h"

namespace spillway {

/// Brings the blocks of leaves and merges, which are ready in any order, into the stream in the
/// order of their numbers, and numbers the vertices.
template <int D>
class Sequencer {
 public:
  /// `writer` and `times` must outlive it.
  Sequencer(MeshStreamWriter& writer, const OutputOptions& output, StageTimes& times);

  /// Takes what settle() made for the stream's block of that number; each number comes once, from
  /// any thread. What can be done before its turn is done in the calling thread.
  void submit(std::uint32_t block, MeshBlock mesh, std::vector<StreamPlace> imported,
              const CanonicalHash<D>& hash);

  /// Vertices, simplices, hash and, where simplices were left out, hull facets of all blocks.
  [[nodiscard]] MeshTotals totals() const;

 private:
  struct Waiting {
    MeshBlock mesh;
    std::vector<StreamPlace> imported;
    std::uint64_t vertices = 0;  ///< that the block announces; the mesh may be encoded already
    std::uint64_t simplices = 0;
  };

  void write(Waiting&& waiting);

  MeshStreamWriter& writer_;
  StageTimes& times_;
  mutable std::mutex mutex_;
  std::map<std::uint32_t, Waiting> waiting_;
  std::vector<std::uint64_t> first_vertex_;  ///< by block that is written
  std::uint64_t vertices_ = 0;
  std::uint64_t simplices_ = 0;
  CanonicalHash<D> hash_;
  bool counts_facets_;
  OpenFacets<D> open_facets_;
};

}  // namespace spillway

#pragma once

#include "formats/meshes/common/live_vertices.h"
#include "formats/meshes/common/mesh_stream.h"
#include "stream/sinks/dem.h"

namespace spillway::detail {

/// Paints a mesh of triangles as its blocks come: those whose vertices come in the same block when
/// the block is absorbed, by many threads at once, the others when it is written. Of the mesh only
/// vertices that are still to come again stay in memory.
class DemWriter : public BlockSink {
 public:
  /// `dem` must outlive it, and must have begun before the first block comes.
  explicit DemWriter(Dem& dem) : dem_(dem) {}

  /// Paints into the Dem, which all threads share, and leaves in the block what write() needs.
  void absorb(MeshBlock& block) override;
  void write(MeshBlock&& block) override;
  void finish(const MeshTotals& totals) override;

 private:
  Dem& dem_;                        ///< takes triangles from many threads at once
  LiveVertices<PlacedPoint> live_;  ///< of write() alone
};

}  // namespace spillway::detail

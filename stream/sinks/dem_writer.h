#pragma once

#include <cstdint>

#include "formats/meshes/common/live_vertices.h"
#include "formats/meshes/common/mesh_stream.h"
#include "stream/sinks/dem.h"

namespace spillway::detail {

/// Paints a mesh of triangles as its blocks come: those whose vertices come in the same block when
/// the block is prepared, by many threads at once, the others when it is written. Of the mesh only
/// vertices that are still to come again stay in memory.
class DemWriter : public MeshStreamWriter {
 public:
  /// `dem` must outlive it, and must have begun before the first block comes.
  explicit DemWriter(Dem& dem) : dem_(dem) {}

  void prepare(MeshBlock& block) const override;
  void write(MeshBlock&& block) override;
  void finish(const MeshTotals& totals) override;
  [[nodiscard]] std::uint64_t bytes_written() const override { return 0; }

 private:
  Dem& dem_;
  LiveVertices<Point<3>> live_;  ///< placed
};

}  // namespace spillway::detail

#pragma once

#include <optional>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_stream.h"

namespace spillway::checker {

/// A periodic mesh in memory as a stream of one block, whose simplices keep their numbers. Vertices
/// are in output coordinates and have no lattice: that of the mesh is for whoever reads. There are no
/// totals.
class WholeStream final : public MeshStreamReader {
 public:
  /// `mesh` must outlive it. Throws Failure for corners that are no vertices, and (kTooLarge) for
  /// more vertices than short numbers tell apart.
  explicit WholeStream(const Mesh& mesh);

  [[nodiscard]] const MeshStreamHeader& header() const override { return header_; }
  bool read(MeshStreamBlock& block) override;
  [[nodiscard]] const MeshTotals& totals() const override { return totals_; }
  [[nodiscard]] bool has_hash() const override { return false; }
  [[nodiscard]] std::optional<double> fraction_read() const override { return std::nullopt; }

 private:
  const Mesh& mesh_;
  MeshStreamHeader header_;
  MeshTotals totals_;
  bool ended_ = false;
};

}  // namespace spillway::checker

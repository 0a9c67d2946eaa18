#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/box.h"

namespace spillway::stream {

/// The facets of one simplex only.
std::uint64_t count_boundary_facets(const Mesh& mesh);

/// The lattice on which a stream of the mesh is: that of its file, if all vertices lie on it.
std::optional<IntegerLattice> stream_lattice(const Mesh& mesh);

/// A mesh in memory, read as a stream: of one block, unless that would be too large.
class WholeMesh final : public MeshStreamReader {
 public:
  /// `name` is for messages. Hull facets and hash are counted if `all_totals`. Throws Failure
  /// (kTooLarge) for more vertices than short numbers tell apart.
  WholeMesh(Mesh mesh, const std::string& name, bool all_totals);

  [[nodiscard]] const MeshStreamHeader& header() const override { return header_; }
  bool read(MeshStreamBlock& block) override;
  [[nodiscard]] const MeshTotals& totals() const override { return totals_; }
  [[nodiscard]] bool has_hash() const override { return all_totals_; }
  [[nodiscard]] std::optional<double> fraction_read() const override { return std::nullopt; }

  /// Throws Failure if more than two simplices have a facet, so that the totals are not those that a
  /// reader of a stream counts. Only where all totals were wanted.
  void refuse_crowded_facet(const std::string& name) const;

  /// The box around all vertices in x and y, as they are in the block.
  [[nodiscard]] const Box<2>& extent() const { return extent_; }

 private:
  bool all_totals_;
  MeshStreamHeader header_;
  MeshTotals totals_;
  std::vector<std::uint64_t> crowded_;  ///< vertices of a facet of more than two simplices
  Box<2> extent_;
  std::vector<MeshStreamBlock> blocks_;
  std::size_t read_ = 0;  ///< of these
};

}  // namespace spillway::stream

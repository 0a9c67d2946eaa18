#pragma once

#include <spillway/mesh.h>

#include <fmt/format.h>

#include <cstdint>
#include <optional>

#include "formats/meshes/common/mesh_stream.h"
#include "src/error.h"
#include "stream/library/meshes/public_values.h"

namespace spillway::stream {

/// A program's own mesh, as the engine reads it.
class ProgramMesh final : public MeshStreamReader {
 public:
  /// `source` must outlive it.
  explicit ProgramMesh(spillway::MeshSource& source) : source_(source), blocks_(source.header()) {}

  [[nodiscard]] const MeshStreamHeader& header() const override { return blocks_.header(); }
  bool read(MeshStreamBlock& block) override {
    MeshBlock next;
    if (source_.read(next)) {
      block = blocks_.next(next);
      return true;
    }
    totals_ = source_.totals();
    fill_in(totals_.vertices, blocks_.vertices(), "vertices");
    fill_in(totals_.simplices, blocks_.simplices(), "simplices");
    return false;
  }
  [[nodiscard]] const MeshTotals& totals() const override { return totals_; }
  [[nodiscard]] bool has_hash() const override {
    return totals_.canonical_hash != 0 && totals_.hull_facets != 0;
  }
  [[nodiscard]] std::optional<double> fraction_read() const override { return std::nullopt; }

 private:
  /// What is not known of a mesh is 0. Throws Failure(kInvalidArgument) for another number.
  static void fill_in(std::uint64_t& told, std::uint64_t came, const char* what) {
    if (told != 0 && told != came) {
      throw InvalidArgument(
          fmt::format("the mesh tells {} {}, but {} have come", told, what, came));
    }
    told = came;
  }

  spillway::MeshSource& source_;
  ProgramBlocks blocks_;
  MeshTotals totals_;
};

}  // namespace spillway::stream

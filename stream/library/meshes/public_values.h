#pragma once
// Between the values of the engine and those that programs see.

#include <spillway/mesh.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "formats/meshes/common/import_check.h"
#include "formats/meshes/common/mesh_stream.h"

namespace spillway::stream {

MeshHeader public_header(const MeshStreamHeader& header);
/// Throws Failure(kInvalidArgument) for an extent that cannot be.
MeshStreamHeader stream_header(const MeshHeader& header);

/// The extent that a header tells, in the coordinates of its blocks.
std::optional<Box<3>> extent_of_blocks(const MeshStreamHeader& header);

/// A block in output coordinates and stream numbers, where `first_vertex` vertices come before it.
MeshBlock public_block(const MeshStreamHeader& header, MeshStreamBlock&& block,
                       std::uint64_t first_vertex);

/// The blocks of a program's mesh as those of a stream.
class ProgramBlocks {
 public:
  /// Throws Failure(kInvalidArgument) for a header that cannot be.
  explicit ProgramBlocks(const MeshHeader& header);

  /// From now on vertices have these attributes alone, which are some of the header's.
  void keep(const AttributeLayout& attributes) { header_.attributes = attributes; }

  /// Throws Failure(kInvalidArgument) for blocks out of their order, coordinates that are not finite,
  /// simplices of another dimension, and vertices that have not come or come no more.
  MeshStreamBlock next(const MeshBlock& block);

  [[nodiscard]] const MeshStreamHeader& header() const { return header_; }
  [[nodiscard]] std::uint64_t vertices() const { return vertices_; }
  [[nodiscard]] std::uint64_t simplices() const { return simplices_; }

 private:
  void check(const MeshBlock& block) const;
  void check_inside(const spillway::Point<3>& vertex, std::uint64_t number) const;
  [[nodiscard]] std::vector<LatticePoint> vertices_of(const MeshBlock& block) const;
  [[nodiscard]] LatticePoint found(const spillway::Point<3>& vertex, std::uint64_t number) const;
  void check_further(const MeshStreamBlock& block) const;
  void check_told(const Point<3>& told, const spillway::Point<3>& vertex,
                  std::uint64_t number) const;

  MeshStreamHeader header_;
  AttributeLayout told_;  ///< the attributes that blocks have
  ImportCheck imports_;
  std::uint64_t vertices_ = 0;  ///< that have come, like the next
  std::uint64_t simplices_ = 0;
};

}  // namespace spillway::stream

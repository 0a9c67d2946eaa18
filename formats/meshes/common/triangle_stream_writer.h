#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/stream_vertices.h"
#include "src/error.h"

namespace spillway::formats {

/// What the formats have in common that repeat the corners with every triangle and number no
/// vertices: blocks are checked here and their triangles passed on with coordinates, in the memory
/// of the stream's border. Vertices of no triangle are not in such files.
class TriangleStreamWriter : public MeshStreamWriter {
 public:
  void write(MeshStreamBlock&& block) final;
  void finish(const MeshTotals& totals) final;

 protected:
  /// `name` is that of the output, for messages.
  TriangleStreamWriter(MeshStreamHeader header, std::string name);

  /// Appends a triangle in output coordinates.
  virtual void put_triangle(const std::array<WorldPoint, 3>& corners) = 0;

  /// Called once, after all triangles.
  virtual void complete() = 0;

  [[nodiscard]] const MeshStreamHeader& header() const { return header_; }
  [[nodiscard]] std::uint64_t triangles() const { return triangles_; }
  [[noreturn]] void fail(const std::string& what,
                         ErrorCode code = ErrorCode::kInvalidArgument) const;

 private:
  void take_positions(const MeshStreamBlock& block);
  void check_short_numbers(const MeshStreamBlock& block) const;

  MeshStreamHeader header_;
  std::string name_;
  StreamVertices<WorldPoint> live_;
  std::vector<WorldPoint> positions_;  // of the block in work, by short number
  std::uint64_t triangles_ = 0;        // written so far
};

}  // namespace spillway::formats

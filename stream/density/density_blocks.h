#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <spillway/density.h>
#include <spillway/live_vertices.h>
#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/stream_vertices.h"
#include "src/geometry/box.h"
#include "src/runtime/memory_budget.h"
#include "stream/density/placed_simplices.h"

namespace spillway::stream {

/// The only attribute of vertices that leave DensityBlocks.
inline constexpr const char* kDensity = "density";

/// What a header says of a mesh whose vertices carry their density.
MeshStreamHeader with_density(MeshStreamHeader header);

/// Turns a mesh into the same one, whose vertices carry their density. That of a vertex is known when
/// its last simplex has come, so vertices leave in another order, and simplices wait until all of
/// their corners have left: as many as lie along the border.
class DensityBlocks final : public BlockSink {
 public:
  /// `header` is that of the mesh that comes; `weight` an attribute of its vertices, or empty.
  /// `sink` gets the blocks; it and `budget` must outlive this.
  DensityBlocks(BlockSink& sink, MeshStreamHeader header, std::string weight, MemoryBudget& budget);

  void write(MeshStreamBlock&& block) override;
  /// Lets go what is left. Does not finish the sink.
  void finish(const MeshTotals& totals) override;

  [[nodiscard]] const DensityTotals& totals() const { return totals_; }
  /// Around all vertices, in output coordinates.
  [[nodiscard]] const Box<3>& extent() const { return extent_; }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// A vertex, while something of it is still to come or to wait for.
  struct Vertex {
    LatticePoint point;
    std::uint64_t input_index = 0;
    double mass = 0;
    double volume = 0;         ///< of the simplices so far
    std::uint64_t number = 0;  ///< in the new mesh, once it has left
    bool has_left = false;
    bool is_forgotten = false;
    std::uint32_t waiting = 0;         ///< corners of simplices that wait
    std::uint32_t first_link = kNone;  ///< of these, those that wait for this vertex
  };
  /// A simplex that waits.
  struct Waiting {
    SimplexCorners vertices;  ///< places in vertices_
    SimplexOffsets offsets;
    std::array<std::uint32_t, 4> links;  ///< by corner: the next of its vertex
    int missing = 0;                     ///< corners that have not left
  };
  /// The block that is being made.
  struct Made {
    MeshStreamBlock block;
    std::vector<std::uint32_t> across;  ///< corners of simplices with offsets, which come last
    LiveVertices<std::uint32_t> imports;
  };

  void take_vertices(const MeshStreamBlock& block);
  void take_volumes(const MeshStreamBlock& block);
  void let_go(std::uint32_t place, Made& made);
  void add_simplex(const SimplexCorners& vertices, const SimplexOffsets& offsets, Made& made);
  void wait(const SimplexCorners& vertices, const SimplexOffsets& offsets);
  void release_waiting(std::uint32_t place, Made& made);
  void forget_if_done(std::uint32_t place, Made& made);
  [[nodiscard]] std::uint32_t short_number(std::uint32_t place, Made& made) const;
  void pass_on(Made& made);
  [[nodiscard]] double volume_of(const SimplexCorners& vertices,
                                 const SimplexOffsets& offsets) const;
  std::uint32_t enter(const Vertex& vertex);

  BlockSink& sink_;
  const MeshStreamHeader header_;
  const std::string weight_;
  const std::size_t corners_;  ///< of a simplex
  ShrinkingLease memory_;
  std::uint64_t leased_ = 0;
  std::uint64_t left_ = 0;  ///< and those that have left
  std::vector<Vertex> vertices_;
  std::vector<std::uint32_t> free_vertices_;
  std::vector<Waiting> waiting_;
  std::vector<std::uint32_t> free_waiting_;
  StreamVertices<std::uint32_t> live_;  ///< by number: the place in vertices_
  std::vector<std::uint32_t> places_;   ///< of the block that is written, by short number
  DensityTotals totals_;
  Box<3> extent_;
};

}  // namespace spillway::stream

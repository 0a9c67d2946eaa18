#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/stream_vertices.h"
#include "stream/library/tiling/mesh_tiling.h"
#include "stream/library/tiling/records_by_tile.h"
#include "stream/library/tiling/tile_mesh.h"

namespace spillway::stream {

/// Deals a mesh into tiles: each simplex goes whole to where the centroid of its corners lies in x
/// and y, with its vertices, which each tile numbers by itself. Of the mesh only vertices that are
/// still to come again stay in memory.
class MeshDivider final : public BlockSink {
 public:
  /// `tiling` and `records` must outlive it.
  MeshDivider(const MeshStreamHeader& header, MeshTiling& tiling, RecordsByTile& records);

  void write(MeshStreamBlock&& block) override;
  void finish(const MeshTotals& totals) override;

  /// Of the mesh of a tile, by its number; all have come.
  [[nodiscard]] const TileCounts& counts(std::size_t tile) const { return counts_[tile]; }
  /// Vertices that are in some tile, each counted once.
  [[nodiscard]] std::uint64_t vertices() const { return placed_; }
  /// Simplices that are in no tile.
  [[nodiscard]] std::uint64_t outside() const { return outside_; }

 private:
  /// A number that a vertex has in a tile.
  struct Place {
    std::size_t tile = 0;
    std::uint32_t number = 0;
  };
  /// One that is to come again.
  struct Vertex {
    LatticePoint point;
    std::optional<std::uint64_t> input_index{};
    std::vector<std::byte> attributes{};
    std::vector<Place> places{};
  };
  /// Places of a block's vertices are chains: the next one is by its position.
  struct Link {
    Place place;
    std::uint32_t next = kNone;
  };
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  template <typename Put>
  void add_record(std::size_t tile, const Put& put);
  void enter(const MeshStreamBlock& block);
  void leave(const MeshStreamBlock& block);
  void add_place(std::uint32_t vertex, const Place& place);
  [[nodiscard]] Point<2> centroid(std::span<const std::uint32_t> corners);
  std::uint32_t number_in(std::size_t tile, std::uint32_t vertex, const MeshStreamBlock& block);
  void put_simplex(std::size_t tile, std::span<const std::uint32_t> corners,
                   const MeshStreamBlock& block);

  const MeshStreamHeader header_;
  MeshTiling& tiling_;
  RecordsByTile& records_;
  std::vector<TileCounts> counts_;
  StreamVertices<Vertex> live_;
  std::uint64_t outside_ = 0;
  std::uint64_t placed_ = 0;
  // Of a block, by short number.
  std::vector<Point<2>> points_;        ///< in output coordinates
  std::vector<std::uint32_t> heads_;    ///< of the chains of places
  std::vector<const Vertex*> earlier_;  ///< those that are imported
  std::vector<Link> links_;
  Packer record_;
  // Of a simplex.
  std::vector<double> coordinates_;
  std::vector<std::size_t> tiles_;
};

}  // namespace spillway::stream

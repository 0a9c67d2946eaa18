#pragma once
// The mesh of a tile as records, which a reader gives back as a stream.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "src/runtime/packing.h"
#include "stream/library/tiling/records_by_tile.h"

namespace spillway::stream {

/// Of the mesh of a tile.
struct TileCounts {
  std::uint32_t vertices = 0;
  std::uint64_t simplices = 0;
};

/// Vertices of a tile have the numbers 0, 1, 2, ... in the order in which their records come.
/// The index in the input is there if the header says so.
void put_vertex(Packer& record, const LatticePoint& point, std::optional<std::uint64_t> input_index,
                std::span<const std::byte> attributes);
/// By the numbers of vertices that have come.
void put_simplex(Packer& record, std::span<const std::uint32_t> corners);
/// No simplex that comes has this vertex.
void put_finalized(Packer& record, std::uint32_t vertex);

/// A tile as a mesh of its own, without what the header says of the whole.
class TileMesh final : public MeshStreamReader {
 public:
  /// `records` must outlive it. Its totals are the counts alone.
  TileMesh(const MeshStreamHeader& whole, const TileCounts& counts, const RecordsByTile& records,
           std::size_t tile);

  [[nodiscard]] const MeshStreamHeader& header() const override { return header_; }
  bool read(MeshStreamBlock& block) override;
  [[nodiscard]] const MeshTotals& totals() const override { return totals_; }
  [[nodiscard]] bool has_hash() const override { return false; }
  [[nodiscard]] std::optional<double> fraction_read() const override { return {}; }

 private:
  void take_record(MeshStreamBlock& block);

  MeshStreamHeader header_;
  MeshTotals totals_;
  RecordsByTile::Reader records_;
  std::vector<std::byte> bytes_;
  std::optional<Unpacker> left_;  ///< of these bytes
  std::uint64_t vertices_ = 0;    ///< that have come before the block
  std::vector<std::uint32_t> corners_;
  std::vector<std::uint32_t> finalized_;
};

}  // namespace spillway::stream

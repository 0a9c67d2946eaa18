#include "stream/library/tiling/tile_mesh.h"

#include "formats/meshes/common/stream_numbers.h"

namespace spillway::stream {
namespace {

enum class Record : std::uint8_t { kVertex, kSimplex, kFinalized };

/// A block ends with the record that brings it to so many simplices or vertices.
constexpr std::size_t kBlockSize = 4096;

}  // namespace

void put_vertex(Packer& record, const LatticePoint& point, std::optional<std::uint64_t> input_index,
                std::span<const std::byte> attributes) {
  record.put(Record::kVertex);
  record.put(point);
  if (input_index) record.put(*input_index);
  record.put_bytes(attributes);
}

void put_simplex(Packer& record, std::span<const std::uint32_t> corners) {
  record.put(Record::kSimplex);
  record.put_bytes(std::as_bytes(corners));
}

void put_finalized(Packer& record, std::uint32_t vertex) {
  record.put(Record::kFinalized);
  record.put(vertex);
}

TileMesh::TileMesh(const MeshStreamHeader& whole, const TileCounts& counts,
                   const RecordsByTile& records, std::size_t tile)
    : header_(whole), records_(records, tile) {
  header_.points.reset();
  header_.extent.reset();
  totals_.vertices = counts.vertices;
  totals_.simplices = counts.simplices;
  totals_.points = counts.vertices;
}

void TileMesh::take_record(MeshStreamBlock& block) {
  switch (left_->take<Record>()) {
    case Record::kVertex: {
      block.vertices.push_back(left_->take<LatticePoint>());
      if (header_.has_input_index) block.input_index.push_back(left_->take<std::uint64_t>());
      const auto record = left_->take_bytes(header_.attributes.record_size());
      block.attributes.insert(block.attributes.end(), record.begin(), record.end());
      return;
    }
    case Record::kSimplex:
      for (int i = 0; i <= header_.dimension; ++i) {
        corners_.push_back(left_->take<std::uint32_t>());
      }
      return;
    case Record::kFinalized:
      finalized_.push_back(left_->take<std::uint32_t>());
  }
}

bool TileMesh::read(MeshStreamBlock& block) {
  block.clear();
  corners_.clear();
  finalized_.clear();
  while (block.vertices.size() < kBlockSize && corners_.size() < 4 * kBlockSize) {
    if (!left_ || left_->empty()) {
      if (!records_.next(bytes_)) break;
      left_.emplace(bytes_);
      continue;
    }
    take_record(block);
  }
  ShortNumbers numbers(vertices_, block.vertices.size());
  for (const std::uint32_t corner : corners_) block.corners.push_back(numbers.of(corner));
  for (const std::uint32_t vertex : finalized_) block.finalized.push_back(numbers.of(vertex));
  block.imported = numbers.take_imported();
  vertices_ += block.vertices.size();
  return !block.vertices.empty() || !block.corners.empty() || !block.finalized.empty();
}

}  // namespace spillway::stream

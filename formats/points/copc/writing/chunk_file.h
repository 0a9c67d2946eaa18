#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/points/common/point_writer.h"
#include "formats/points/copc/node_key.h"
#include "formats/points/las/laz_record.h"
#include "formats/points/laz/chunk_encoder.h"
#include "formats/points/laz/chunk_table.h"

namespace spillway::formats {

/// A node whose chunk is to be written.
struct NodeToWrite {
  NodeKey key;
  std::uint64_t count = 0;  ///< of points: one at least
  /// Gives the encoder all its records.
  std::function<void(LazChunkEncoder& encoder)> give{};
};

/// The chunks of a COPC file, one for each node.
class ChunkFile {
 public:
  struct Limits {
    std::size_t bytes_at_once = 0;  ///< of records of nodes that are encoded beside each other
  };

  /// The first chunk begins at byte `begin` of the file, which outlives this.
  ChunkFile(OutputFile& file, std::uint64_t begin, LazChunkFormat format, std::size_t record_length,
            const WorkSharing& sharing, const Limits& limits);

  /// Writes chunks in this order; several are encoded at a time.
  void write(std::span<const NodeToWrite> nodes);

  [[nodiscard]] const std::vector<HierarchyEntry>& entries() const { return entries_; }
  [[nodiscard]] const std::vector<LazChunk>& chunks() const { return chunks_; }
  /// The byte behind the last chunk.
  [[nodiscard]] std::uint64_t end() const { return end_; }

 private:
  void write_together(std::span<const NodeToWrite> nodes);
  void add(const NodeToWrite& node, std::span<const std::byte> chunk);

  OutputFile& file_;
  std::uint64_t end_;
  LazChunkFormat format_;
  std::size_t record_length_;
  const WorkSharing& sharing_;
  Limits limits_;
  std::vector<HierarchyEntry> entries_;
  std::vector<LazChunk> chunks_;
};

}  // namespace spillway::formats

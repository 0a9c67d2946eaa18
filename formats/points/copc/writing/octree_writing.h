#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/points/common/point_writer.h"
#include "formats/points/copc/writing/chunk_file.h"
#include "formats/points/copc/writing/octree_cube.h"
#include "formats/points/copc/writing/octree_dealing.h"
#include "formats/points/copc/writing/octree_rules.h"
#include "formats/points/copc/writing/record_lists.h"

namespace spillway::formats {

/// From records to the chunks of an octree's nodes, within a limit of memory.
class OctreeWriting {
 public:
  struct Resources {
    ScratchFolder* scratch = nullptr;  ///< without, all is done in memory
    WorkSharing sharing{};
    std::size_t bytes_in_memory = 0;  ///< of records that are divided at a time
    int levels_at_once = 3;           ///< that more records are dealt into, at most
    /// Told how many records have been written; what it throws ends the writing.
    std::function<void(std::uint64_t records)> progress = [](std::uint64_t) {};
  };

  OctreeWriting(const Resources& resources, std::size_t record_length, const OctreeCube& cube,
                const OctreeRules& rules, ChunkFile& chunks);

  /// Writes all nodes of the octree of the records that are list 0.
  void write_all(RecordLists& records);

 private:
  void write_parts(RecordLists& lists, const std::vector<OctreePart>& parts);
  void write_small(RecordLists& lists, std::span<const OctreePart> parts);
  void write_nodes(std::span<const NodeToWrite> nodes);
  void write_large(RecordLists& lists, const OctreePart& part);

  Resources resources_;
  std::size_t record_length_;
  const OctreeCube& cube_;
  const OctreeRules& rules_;
  ChunkFile& chunks_;
  std::uint64_t written_ = 0;  ///< records
};

}  // namespace spillway::formats

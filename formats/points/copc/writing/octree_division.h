#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/points/common/point_writer.h"
#include "formats/points/copc/node_key.h"
#include "formats/points/copc/writing/octree_cube.h"
#include "formats/points/copc/writing/octree_rules.h"

namespace spillway::formats {

/// A subtree of the octree, of records in memory.
struct DividedRecords {
  struct Node {
    NodeKey key;
    std::size_t first = 0;  ///< in `order`
    std::size_t count = 0;
  };

  std::vector<std::uint32_t> order;  ///< numbers of records, node by node, ascending in each
  std::vector<Node> nodes;           ///< each before those below it
};

/// Divides the records that lie in the node `top` and in no node above it. Its children are worked
/// on beside each other, by `sharing`.
DividedRecords divide_records(std::span<const std::byte> records, std::size_t record_length,
                              const NodeKey& top, const OctreeCube& cube, const OctreeRules& rules,
                              const WorkSharing& sharing);

}  // namespace spillway::formats

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/points/copc/node_key.h"
#include "formats/points/copc/writing/octree_cube.h"
#include "formats/points/copc/writing/octree_rules.h"
#include "formats/points/copc/writing/record_lists.h"
#include "formats/points/copc/writing/sample_grid.h"

namespace spillway::formats {

/// Some records of the octree.
struct OctreePart {
  NodeKey key;
  std::vector<std::size_t> lists{};  ///< that hold them, one after the other
  std::uint64_t count = 0;
  bool is_node = false;  ///< they are those of that node; else those of it and of all below it
};

/// A subtree of more records than there is memory for: they are dealt into the samples of its upper
/// levels and the subtrees below these.
class OctreeDealing {
 public:
  /// `top` is the node above all; the subtrees begin so many levels below it, as far as there are
  /// nodes.
  OctreeDealing(ScratchFolder* scratch, std::size_t record_length, const NodeKey& top, int levels,
                const OctreeCube& cube, const OctreeRules& rules);

  /// Deals the next records.
  void deal(std::span<const std::byte> records);

  /// What all records have become, once all are dealt, each part before those below it.
  [[nodiscard]] std::vector<OctreePart> parts();

  /// Where they are.
  [[nodiscard]] RecordLists& lists() { return lists_; }

 private:
  [[nodiscard]] std::uint64_t count_below(std::size_t number, int level) const;
  void add_lists_below(std::size_t number, int level, std::vector<std::size_t>& lists) const;
  void add_parts(std::size_t number, const NodeKey& key, std::vector<OctreePart>& parts) const;

  std::size_t record_length_;
  NodeKey top_;
  int last_level_;  // of the subtrees
  const OctreeCube& cube_;
  const OctreeRules& rules_;
  // Nodes and subtrees are numbered level by level: the first child of number n is 8 n + 1.
  std::vector<std::optional<SampleGrid>> grids_;  // of nodes that have a point
  RecordLists lists_;
};

}  // namespace spillway::formats

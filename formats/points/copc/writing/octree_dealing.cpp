#include "formats/points/copc/writing/octree_dealing.h"

#include <algorithm>

namespace spillway::formats {
namespace {

constexpr std::size_t kOctants = 8;

std::size_t child_number(std::size_t number, std::size_t octant) {
  return kOctants * number + 1 + octant;
}

NodeKey child_key(const NodeKey& key, std::size_t octant) {
  NodeKey child{.level = key.level + 1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    child.cell[axis] = 2 * key.cell[axis] + static_cast<std::int32_t>(octant >> axis & 1U);
  }
  return child;
}

/// Nodes of so many whole levels.
std::size_t nodes_of(int levels) {
  return ((std::size_t{1} << 3 * static_cast<unsigned>(levels)) - 1) / (kOctants - 1);
}

int last_level_of(const NodeKey& top, int levels, const OctreeCube& cube) {
  return std::min(top.level + levels, cube.depth());
}

}  // namespace

OctreeDealing::OctreeDealing(ScratchFolder* scratch, std::size_t record_length, const NodeKey& top,
                             int levels, const OctreeCube& cube, const OctreeRules& rules)
    : record_length_(record_length),
      top_(top),
      last_level_(last_level_of(top, levels, cube)),
      cube_(cube),
      rules_(rules),
      grids_(nodes_of(last_level_ - top.level)),
      lists_(scratch, record_length, nodes_of(last_level_ - top.level + 1), {}) {}

void OctreeDealing::deal(std::span<const std::byte> records) {
  for (; !records.empty(); records = records.subspan(record_length_)) {
    const CubePlace place = cube_.place_of(records.data());
    std::size_t number = 0;
    for (int level = top_.level; level < last_level_; ++level) {
      if (!grids_[number]) grids_[number].emplace(rules_.sample_bits);
      const std::size_t cell = cube_.sample_cell_of(place, level, rules_.sample_bits);
      if (lists_.count(number) < rules_.most_points && grids_[number]->take(cell)) break;
      number = child_number(number, cube_.octant_of(place, level));
    }
    lists_.append(number, records.first(record_length_));
  }
}

std::vector<OctreePart> OctreeDealing::parts() {
  grids_ = std::vector<std::optional<SampleGrid>>();
  std::vector<OctreePart> parts;
  add_parts(0, top_, parts);
  return parts;
}

std::uint64_t OctreeDealing::count_below(std::size_t number, int level) const {
  std::uint64_t count = lists_.count(number);
  for (std::size_t octant = 0; level < last_level_ && octant < kOctants; ++octant) {
    count += count_below(child_number(number, octant), level + 1);
  }
  return count;
}

void OctreeDealing::add_lists_below(std::size_t number, int level,
                                    std::vector<std::size_t>& lists) const {
  if (lists_.count(number) > 0) lists.push_back(number);
  for (std::size_t octant = 0; level < last_level_ && octant < kOctants; ++octant) {
    add_lists_below(child_number(number, octant), level + 1, lists);
  }
}

void OctreeDealing::add_parts(std::size_t number, const NodeKey& key,
                              std::vector<OctreePart>& parts) const {
  const std::uint64_t all = count_below(number, key.level);
  if (all == 0) return;
  OctreePart part{.key = key};
  if (key.level == last_level_ || all <= rules_.most_points) {
    part.count = all;
    part.is_node = all <= rules_.most_points || key.level == cube_.depth();
    add_lists_below(number, key.level, part.lists);
    parts.push_back(std::move(part));
    return;
  }
  part.count = lists_.count(number);
  part.is_node = true;
  part.lists = {number};
  parts.push_back(std::move(part));
  for (std::size_t octant = 0; octant < kOctants; ++octant) {
    add_parts(child_number(number, octant), child_key(key, octant), parts);
  }
}

}  // namespace spillway::formats

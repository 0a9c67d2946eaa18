#include "formats/points/copc/writing/octree_division.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "formats/points/copc/writing/sample_grid.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kOctants = 8;

using Node = DividedRecords::Node;
/// Where the points of the children begin in the order, and, last, where those of the eighth end.
using Cuts = std::array<std::size_t, kOctants + 1>;

class Division {
 public:
  Division(std::span<const std::byte> records, std::size_t record_length, const OctreeCube& cube,
           const OctreeRules& rules)
      : cube_(cube), rules_(rules) {
    const std::size_t count = records.size() / record_length;
    places_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      places_.push_back(cube.place_of(&records[i * record_length]));
    }
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0U);
    others_.resize(count);
  }

  DividedRecords run(const NodeKey& top, const WorkSharing& sharing) && {
    DividedRecords all;
    const Node whole{.key = top, .first = 0, .count = order_.size()};
    if (keeps_all(whole)) {
      all.nodes = {whole};
    } else {
      SampleGrid grid(rules_.sample_bits);
      const Cuts cuts = split(whole, grid);
      all.nodes = {{.key = top, .first = 0, .count = cuts[0]}};
      std::array<std::vector<Node>, kOctants> below;
      share(sharing, kOctants, [&](std::size_t octant) {
        if (cuts[octant + 1] == cuts[octant]) return;
        SampleGrid own(rules_.sample_bits);
        divide(child_of(whole, cuts, octant), own, below[octant]);
      });
      for (const std::vector<Node>& nodes : below) {
        all.nodes.insert(all.nodes.end(), nodes.begin(), nodes.end());
      }
    }
    all.order = std::move(order_);
    return all;
  }

 private:
  [[nodiscard]] bool keeps_all(const Node& node) const {
    return node.count <= rules_.most_points || node.key.level >= cube_.depth();
  }

  [[nodiscard]] Node child_of(const Node& node, const Cuts& cuts, std::size_t octant) const {
    const CubePlace& any = places_[order_[cuts[octant]]];
    return {.key = cube_.node_of(any, node.key.level + 1),
            .first = cuts[octant],
            .count = cuts[octant + 1] - cuts[octant]};
  }

  void divide(const Node& node, SampleGrid& grid, std::vector<Node>& nodes) {
    if (keeps_all(node)) {
      nodes.push_back(node);
      return;
    }
    const Cuts cuts = split(node, grid);
    nodes.push_back({.key = node.key, .first = node.first, .count = cuts[0] - node.first});
    for (std::size_t octant = 0; octant < kOctants; ++octant) {
      if (cuts[octant + 1] == cuts[octant]) continue;
      divide(child_of(node, cuts, octant), grid, nodes);
    }
  }

  /// Brings the sample of a node to its front, then the points of each child. `grid` is free before
  /// and after.
  Cuts split(const Node& node, SampleGrid& grid) {
    const int level = node.key.level;
    const std::size_t end = node.first + node.count;
    const auto cell_of = [&](std::size_t i) {
      return cube_.sample_cell_of(places_[order_[i]], level, rules_.sample_bits);
    };
    std::array<std::size_t, kOctants> counts{};
    std::size_t sampled = node.first;
    std::size_t left = node.first;  // in others_
    for (std::size_t i = node.first; i < end; ++i) {
      const std::uint32_t number = order_[i];
      if (sampled - node.first < rules_.most_points && grid.take(cell_of(i))) {
        order_[sampled++] = number;
      } else {
        ++counts[cube_.octant_of(places_[number], level)];
        others_[left++] = number;
      }
    }
    for (std::size_t i = node.first; i < sampled; ++i) grid.free(cell_of(i));
    Cuts cuts{sampled};
    for (std::size_t octant = 0; octant < kOctants; ++octant) {
      cuts[octant + 1] = cuts[octant] + counts[octant];
    }
    Cuts next = cuts;
    for (std::size_t i = node.first; i < left; ++i) {
      order_[next[cube_.octant_of(places_[others_[i]], level)]++] = others_[i];
    }
    return cuts;
  }

  const OctreeCube& cube_;
  const OctreeRules& rules_;
  std::vector<CubePlace> places_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> others_;  // that are not in the sample of the node in hand
};

}  // namespace

DividedRecords divide_records(std::span<const std::byte> records, std::size_t record_length,
                              const NodeKey& top, const OctreeCube& cube, const OctreeRules& rules,
                              const WorkSharing& sharing) {
  return Division(records, record_length, cube, rules).run(top, sharing);
}

}  // namespace spillway::formats

#pragma once
// The octree that a COPC file keeps points in, made as the programs do that write such files: each
// node has a sample of the points in its cube, the nodes below have the others.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spillway::test {

struct PointOctree {
  /// Coordinates on the lattice.
  using Place = std::array<std::int32_t, 3>;

  struct Node {
    std::array<std::int32_t, 4> key{};  ///< level, x, y, z
    std::vector<std::uint32_t> points;  ///< numbers, ascending
  };

  /// Cells along each axis of a node's cube that its sample has one point of.
  static constexpr std::int64_t kCells = 64;

  Place first_corner{};     ///< the root's cube begins half a step of the lattice below it,
  std::int64_t side = 0;    ///< and is so long: no point lies on the side of a node's cube
  std::vector<Node> nodes;  ///< each before those below it
};

/// The octree of these points, of which there is at least one. But for the root, its nodes have
/// some thousand points.
PointOctree make_point_octree(std::span<const PointOctree::Place> points);

}  // namespace spillway::test

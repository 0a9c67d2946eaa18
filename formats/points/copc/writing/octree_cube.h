#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "formats/points/copc/node_key.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"

namespace spillway::formats {

/// Where a point lies in the octree's cube: along each axis, in sample cells of the deepest nodes,
/// of which a node has kFinest along each axis.
using CubePlace = std::array<std::uint32_t, 3>;

/// The cube of the octree, and the cells that it is divided into. Its lowest corner lies half a
/// step of the finest axis below the points, and the sides of all nodes lie whole steps from it: so
/// no point lies on the side of a node, where axes have one scale or scales are multiples of the
/// finest one.
class OctreeCube {
 public:
  /// Sample cells of a node along each axis, at most: a power of 2.
  static constexpr unsigned kFinestBits = 7;

  /// Of no points.
  OctreeCube() = default;
  /// Around these integers of a lattice.
  OctreeCube(const IntegerLattice& lattice, const Box<3>& integers);

  /// The level of the deepest nodes.
  [[nodiscard]] int depth() const { return depth_; }
  /// In output coordinates.
  [[nodiscard]] const std::array<double, 3>& centre() const { return centre_; }
  [[nodiscard]] double halfsize() const { return halfsize_; }

  /// Of a point with these coordinates on the lattice.
  [[nodiscard]] CubePlace place_of(const std::array<std::int32_t, 3>& integers) const {
    CubePlace place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double steps = (integers[axis] - lowest_[axis]) * steps_[axis] + 0.5;
      place[axis] = static_cast<std::uint32_t>(steps * cells_per_step_);
    }
    return place;
  }
  /// Of a LAS record.
  [[nodiscard]] CubePlace place_of(const std::byte* record) const {
    return place_of(load<std::array<std::int32_t, 3>>(record));
  }

  /// The node of that level.
  [[nodiscard]] NodeKey node_of(const CubePlace& place, int level) const {
    NodeKey key{.level = level};
    const unsigned shift = kFinestBits + static_cast<unsigned>(depth_ - level);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      key.cell[axis] = static_cast<std::int32_t>(place[axis] >> shift);
    }
    return key;
  }

  /// Which of the eight children of its node of that level, above the deepest.
  [[nodiscard]] unsigned octant_of(const CubePlace& place, int level) const {
    const unsigned shift = kFinestBits + static_cast<unsigned>(depth_ - level) - 1;
    return (place[0] >> shift & 1U) | (place[1] >> shift & 1U) << 1U |
           (place[2] >> shift & 1U) << 2U;
  }

  /// The sample cell of its node of that level, which has 2^bits along each axis.
  [[nodiscard]] std::size_t sample_cell_of(const CubePlace& place, int level, unsigned bits) const {
    const unsigned shift = kFinestBits + static_cast<unsigned>(depth_ - level) - bits;
    const std::size_t mask = (std::size_t{1} << bits) - 1;
    return (place[0] >> shift & mask) | (place[1] >> shift & mask) << bits |
           (place[2] >> shift & mask) << 2 * bits;
  }

 private:
  int depth_ = 0;
  std::array<double, 3> centre_{};
  double halfsize_ = 1;
  std::array<double, 3> lowest_{};        // integers
  std::array<double, 3> steps_{1, 1, 1};  // of the finest axis in a step of each
  double cells_per_step_ = 1;
};

}  // namespace spillway::formats

#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace spillway::stream {

/// What proves that the simplices which were chosen, one of all copies each, are the triangulation
/// of the torus. Sums over all of them, in any order.
struct TorusProof {
  /// Over the facets near the sides of the box, seen as those of all copies, of a fingerprint each,
  /// added from one side and subtracted from the other one: 0 if every facet has two sides.
  std::uint64_t open_facets = 0;
  /// Simplices near the sides whose circumspheres reach beyond the copies.
  std::uint64_t beyond_margin = 0;
  /// The longest that a simplex is along each axis, of those that may be half a period long.
  std::array<double, 3> reach{};

  [[nodiscard]] bool holds() const { return open_facets == 0 && beyond_margin == 0; }

  void add(const TorusProof& other) {
    open_facets += other.open_facets;
    beyond_margin += other.beyond_margin;
    for (int k = 0; k < 3; ++k) reach[k] = std::max(reach[k], other.reach[k]);
  }
};

}  // namespace spillway::stream

#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace spillway::stream {

/// What proves that the simplices which were chosen, one of all copies each, are the triangulation
/// of the torus. Sums over all of them, in any order.
struct TorusProof {
  /// Over the facets near the sides of the box, seen as those of all copies, of two fingerprints
  /// each, added from one side and subtracted from the other one: 0 if every facet has two sides.
  std::array<std::uint64_t, 2> open_facets{};
  /// Simplices near the sides whose circumspheres reach beyond the copies.
  std::uint64_t beyond_margin = 0;
  /// The longest that a simplex is along each axis, of those that may be half a period long.
  std::array<double, 3> reach{};

  [[nodiscard]] bool closed() const { return open_facets[0] == 0 && open_facets[1] == 0; }

  void add(const TorusProof& other) {
    for (int i = 0; i < 2; ++i) open_facets[i] += other.open_facets[i];
    beyond_margin += other.beyond_margin;
    for (int k = 0; k < 3; ++k) reach[k] = std::max(reach[k], other.reach[k]);
  }
};

}  // namespace spillway::stream

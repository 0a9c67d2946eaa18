#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::library {

/// A point of a triangulation and a cell that it is a vertex of.
template <int D, class Index>
struct StartPoint {
  Point<D> point;
  Index cell;
};

/// Where a walk to a place begins: a balanced k-d tree over some of the vertices, a sample of one
/// in kSampled, with a cell at each leaf. It fits itself to clusters and outliers, as a grid would
/// not.
template <int D, class Index>
class StartTree {
 public:
  static constexpr std::size_t kSampled = 8;

  StartTree() = default;
  /// `sample` must not be empty; it is reordered.
  explicit StartTree(std::vector<StartPoint<D, Index>> sample);

  /// A cell near the place.
  [[nodiscard]] Index find(const Point<D>& place) const {
    std::size_t node = 1;
    while (node < cells_.size()) {
      const Cut& cut = cuts_[node];
      node = 2 * node + (place[cut.axis] < cut.at ? 0 : 1);
    }
    return cells_[node - cells_.size()];
  }

 private:
  struct Cut {
    double at = 0;
    std::uint32_t axis = 0;
  };

  void build(std::size_t node, std::span<StartPoint<D, Index>> sample);

  std::vector<Cut> cuts_;     ///< node n has the children 2n and 2n+1; the root is 1
  std::vector<Index> cells_;  ///< of the leaves, a power of two
};

}  // namespace spillway::library

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "src/delaunay/common/triangulation.h"
#include "src/geometry/periodic_domain.h"
#include "src/geometry/point.h"
#include "src/geometry/torus_simplex.h"
#include "stream/periodic/torus_proof.h"

namespace spillway::stream {

/// Of the simplices of a part, those that stand for all of their copies, and what they tell of the
/// whole. In a periodic domain of D dimensions a simplex is chosen if all its corners are *deep*,
/// at least a margin inside of the box, or else if its centre is in the box (SimplexPlace).
template <int D>
class ChosenSimplices {
 public:
  ChosenSimplices(const PeriodicDomain& domain, std::vector<Point<D>> points);

  /// Whether each simplex of the part is chosen, and tells nothing.
  [[nodiscard]] bool all_chosen() const { return all_deep_ && all_near_; }

  /// Whether a finite simplex is chosen. To be asked once of each.
  bool choose(const std::array<VertexId, D + 1>& corners);
  /// The same of an infinite one, for the facet that it has.
  bool choose_infinite(const std::array<VertexId, D + 1>& corners);

  /// The corners of one that is chosen, in an order of the same orientation. If they are not all in
  /// the box, the first in the order of coordinates comes first.
  [[nodiscard]] std::array<VertexId, D + 1> ordered(std::array<VertexId, D + 1> corners) const;

  /// The point in the box that this one is a copy of.
  [[nodiscard]] Point<D> in_box(const Point<D>& point) const;

  [[nodiscard]] const TorusProof& proof() const { return proof_; }

 private:
  using Corners = std::array<VertexId, D + 1>;

  [[nodiscard]] bool is_deep(const Point<D>& point) const;
  void note_reach(const std::array<Point<D>, D + 1>& corners);
  void add_facet(const std::array<VertexId, D>& facet, bool odd);

  const PeriodicDomain& domain_;
  std::vector<Point<D>> points_;
  std::vector<std::uint8_t> deep_;  ///< by point; empty if all are
  bool all_deep_ = true;
  bool all_near_ = true;  ///< no simplex can be half a period long
  TorusProof proof_;
};

}  // namespace spillway::stream

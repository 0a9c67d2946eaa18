#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "formats/meshes/common/corner_offset.h"
#include "src/delaunay/common/triangulation.h"
#include "src/geometry/periodic_domain.h"
#include "src/geometry/point.h"
#include "src/geometry/torus_simplex.h"
#include "stream/periodic/torus_proof.h"

namespace spillway::stream {

/// What becomes of a simplex of a part in a periodic domain.
enum class Choice : std::uint8_t {
  kInside,   ///< stands for all of its copies, and its corners are in the box
  kAcross,   ///< stands for all of its copies, but is to be ordered()
  kLeftOut,  ///< another copy stands for it
};

/// Of the simplices of a part, those that stand for all of their copies, and what they tell of the
/// whole.
///
/// A simplex is chosen if all its corners are *deep*, at least a margin inside of the box, or else
/// if its centre is in the box (SimplexPlace). docs/periodic.md proves that this gives the
/// triangulation of the torus if the TorusProof of all parts holds.
template <int D>
class ChosenSimplices {
 public:
  ChosenSimplices(const PeriodicDomain& domain, std::vector<Point<D>> points);

  /// Whether each simplex of the part is chosen, and tells nothing.
  [[nodiscard]] bool all_chosen() const { return all_deep_ && all_near_; }

  /// Whether a finite simplex is Choice::kInside, and tells nothing.
  [[nodiscard]] bool is_inside(const std::array<VertexId, D + 1>& corners) const {
    unsigned deep = 1;
    for (const VertexId v : corners) deep &= deep_[v];
    return deep != 0 && all_near_;
  }
  /// What becomes of another one. To be asked once of each.
  Choice choose(const std::array<VertexId, D + 1>& corners);
  /// Whether the facet of an infinite one is chosen.
  bool choose_infinite(const std::array<VertexId, D + 1>& corners);

  /// The corners of a simplex across the sides of the box, in an order of the same orientation: the
  /// first in the order of coordinates comes first.
  [[nodiscard]] std::array<VertexId, D + 1> ordered(std::array<VertexId, D + 1> corners) const;

  /// The point in the box that this one is a copy of.
  [[nodiscard]] Point<D> in_box(const Point<D>& point) const;

  [[nodiscard]] const TorusProof& proof() const { return proof_; }

 private:
  using Corners = std::array<VertexId, D + 1>;

  [[nodiscard]] std::uint64_t fingerprint(const Point<D>& point) const;
  void note_reach(const std::array<Point<D>, D + 1>& corners);
  [[nodiscard]] bool is_deep(const Point<D>& point) const;
  [[nodiscard]] std::uint64_t print_of(VertexId v);
  void add_facets(const Corners& corners);
  void add_facet(const std::array<VertexId, D>& facet, bool odd);

  const PeriodicDomain& domain_;
  std::vector<Point<D>> points_;
  std::vector<std::uint8_t> offsets_;  ///< by point: the CornerOffset of the copy that it is
  std::vector<std::uint64_t> prints_;  ///< by point, of the one in the box; 0: not yet known
  std::vector<std::uint8_t> deep_;     ///< by point: 1 if it is at least a margin inside of the box
  bool all_deep_ = true;
  bool all_near_ = true;  ///< no simplex can be half a period long
  TorusProof proof_;
};

}  // namespace spillway::stream

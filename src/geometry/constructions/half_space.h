#pragma once

#include <array>
#include <optional>

#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::detail {

/// The closed half-space beyond a facet, which is listed so that orientation(facet, p) is positive
/// for p beyond. Its questions are answered exactly.
template <int D>
requires SupportedDimension<D>
class HalfSpace {
 public:
  HalfSpace() = default;
  explicit HalfSpace(const std::array<Point<D>, D>& facet);

  [[nodiscard]] const std::array<Point<D>, D>& facet() const { return facet_; }

  /// Whether it has a point in common with a finite box. True if the facet's points do not span a
  /// hyperplane; false for an empty box.
  [[nodiscard]] bool meets(const Box<D>& box) const;

  /// Whether a point lies in it: its sign beside the hyperplane by rounded arithmetic, as far as
  /// that is certain.
  [[nodiscard]] std::optional<bool> quickly_has(const Point<D>& point) const;

  /// The product of the rounded normal with the vector to a point from the hyperplane, positive
  /// beyond; and how far that may be from the product with the true normal.
  struct Place {
    double beyond = 0;
    double error = 0;
  };
  [[nodiscard]] Place place_of(const Point<D>& point) const;

  /// A normal, rounded; and for each component the sum of the absolute values that it is made of:
  /// it errs by less than 3 ulp of that.
  [[nodiscard]] const Point<D>& normal() const { return normal_; }
  [[nodiscard]] const Point<D>& magnitude() const { return magnitude_; }

 private:
  std::array<Point<D>, D> facet_{};
  std::array<bool, D> upwards_{};  ///< by axis, whether larger coordinates lie farther beyond
  Point<D> normal_{};
  Point<D> magnitude_{};
};

}  // namespace spillway::detail

#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::geometry {

/// The closed half-space beyond a facet, which is listed so that orientation(facet, p) is positive
/// for p beyond. Its questions are answered exactly.
template <int D>
requires Dimension<D>
class HalfSpace {
 public:
  HalfSpace() = default;
  explicit HalfSpace(const std::array<Point<D>, D>& facet);

  [[nodiscard]] const std::array<Point<D>, D>& facet() const { return facet_; }

  /// Whether it has a point in common with a finite box. True if the facet's points do not span a
  /// hyperplane; false for an empty box.
  [[nodiscard]] bool meets(const Box<D>& box) const {
    const Place place = place_of(box);
    return place.certain() ? place.beyond > 0 : meets_exactly(box);
  }

  /// How far beyond the hyperplane something reaches, as the product of the rounded normal with a
  /// vector from there; and how far that may be from the product with the true normal.
  struct Place {
    double beyond = 0;
    double error = 0;

    /// Whether the sign is certain.
    [[nodiscard]] bool certain() const { return std::abs(beyond) > error; }
  };
  [[nodiscard]] Place place_of(const Point<D>& point) const {
    return place_of(Box<D>{point, point});
  }
  /// Of the corner that reaches farthest. Without branches: nobody can tell which that is.
  [[nodiscard]] Place place_of(const Box<D>& box) const {
    constexpr double kError = D <= 3 ? 0x1p-48 : 0x1p-47;
    constexpr double kSmallest = 0x1p-900;
    Place place;
    double scale = 0;
    double reach = 0;
    for (int k = 0; k < D; ++k) {
      const double low = box.lo[k] - facet_[0][k];
      const double high = box.hi[k] - facet_[0][k];
      const double farthest = std::max(std::abs(low), std::abs(high));
      place.beyond += std::max(normal_[k] * low, normal_[k] * high);
      scale += magnitude_[k] * farthest;
      reach += farthest;
    }
    place.error = kError * scale + kSmallest * (1 + reach);
    return place;
  }

  /// A normal, rounded; and for each component the sum of the absolute values that it is made of:
  /// it errs by less than 3 ulp of that (D > 3: 11 ulp).
  [[nodiscard]] const Point<D>& normal() const { return normal_; }
  [[nodiscard]] const Point<D>& magnitude() const { return magnitude_; }

 private:
  [[nodiscard]] bool meets_exactly(const Box<D>& box) const;

  std::array<Point<D>, D> facet_{};
  Point<D> normal_{};
  Point<D> magnitude_{};
};

}  // namespace spillway::geometry

#pragma once
// Stages of the 2D kernel's predicates in double arithmetic: with error bounds, and exactly on
// lattices. The bounds are derived in docs/algorithm-kernel-2d.md.

#include <algorithm>

#include "src/geometry/point.h"
#include "src/geometry/predicate_stages.h"

namespace spillway::delaunay::kernel_2d {

/// Two numbers that are computed with side by side.
using Pair [[gnu::vector_size(16)]] = double;

/// A vertex as seen from the point that is being inserted.
struct Corner {
  Pair at;        ///< x, y
  double square;  ///< x^2 + y^2

  Corner() = default;
  Corner(const Pair& at_, double square_) : at(at_), square(square_) {}
  // Member by member: the compiler would copy the padding, too, and wait for it.
  Corner(const Corner& other) : at(other.at), square(other.square) {}
  Corner& operator=(const Corner& other) {
    at = other.at;
    square = other.square;
    return *this;
  }
  ~Corner() = default;
};

inline Pair pair_of(const Point<2>& p) { return Pair{p[0], p[1]}; }

inline Corner corner_at(const Point<2>& vertex, const Pair& query) {
  const Pair at = pair_of(vertex) - query;
  const Pair squares = at * at;
  return {at, squares[0] + squares[1]};
}

/// Positive if b lies to the left of a, as seen from the query.
inline double cross(const Corner& a, const Corner& b) {
  return a.at[0] * b.at[1] - a.at[1] * b.at[0];
}

/// Positive if the query is in conflict with the triangle beyond its edge from -> to, whose third
/// vertex is the apex; NaN if that is infinite.
inline double in_circle_determinant(const Corner& from, const Corner& to, const Corner& apex) {
  return to.square * cross(from, apex) - from.square * cross(to, apex) -
         apex.square * cross(from, to);
}

/// What underflow may add to the errors, in coordinates of extent 1 to 2.
inline constexpr double kUnderflow = 0x1p-1000;

/// Bound of the error of a computed cross().
inline double cross_bound(double largest) { return 5 * stages::kRoundoff * largest + kUnderflow; }

/// Computed from integers, the determinant is exact up to this `largest`: 3 largest^2 <= 2^53.
inline constexpr double kExactInCircle = 54'794'157;

inline double largest_square(const Corner& a, const Corner& b, const Corner& c) {
  return std::max(c.square, std::max(a.square, b.square));
}

/// The tie rule for four points on a circle, of which `from`, `to` and `apex` are a triangle beyond
/// the edge from -> to, seen from the query: the triangle is in conflict unless the
/// lexicographically largest of the four is the apex or the query. For lattice points within
/// kExactInCircle.
inline bool tie_conflicts(const Corner& from, const Corner& to, const Corner& apex) {
  // Coordinates are below 2^13, so one number orders them as the pair does.
  const auto order_key = [](const Corner& c) { return c.at[0] * 0x1p14 + c.at[1]; };
  return std::max(order_key(from), order_key(to)) > std::max(order_key(apex), 0.0);
}

}  // namespace spillway::delaunay::kernel_2d

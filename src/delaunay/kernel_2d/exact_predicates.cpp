#include "src/delaunay/kernel_2d/exact_predicates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "src/delaunay/kernel_2d/filters.h"
#include "src/geometry/predicates.h"

namespace spillway::delaunay::kernel_2d {
namespace {

/// An unevaluated sum of two doubles, the second at most half a unit in the last place of the
/// first. Operations and their error bounds: M. Joldes, J.-M. Muller, V. Popescu, "Tight and
/// rigorous error bounds for basic building blocks of double-word arithmetic", ACM TOMS 44 (2017).
struct DoubleDouble {
  double high, low;
};

DoubleDouble fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

DoubleDouble two_sum(double a, double b) {
  const double sum = a + b;
  const double b_rounded = sum - a;
  return {sum, (a - (sum - b_rounded)) + (b - b_rounded)};
}

/// The upper half of a double's bits (Veltkamp's splitting).
double upper_half(double a) {
  constexpr double kSplitter = 0x1p27 + 1;
  const double c = kSplitter * a;
  return c - (c - a);
}

/// The exact product (Dekker), without a fused multiply-add, which not every processor has.
DoubleDouble two_product(double a, double b) {
  const double product = a * b;
  const double ah = upper_half(a);
  const double al = a - ah;
  const double bh = upper_half(b);
  const double bl = b - bh;
  return {product, ((ah * bh - product) + ah * bl + al * bh) + al * bl};
}

/// AccurateDWPlusDW: relative error below 4 u^2.
DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble s = two_sum(a.high, b.high);
  const DoubleDouble t = two_sum(a.low, b.low);
  const DoubleDouble v = fast_two_sum(s.high, s.low + t.high);
  return fast_two_sum(v.high, t.low + v.low);
}

DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
  return a + DoubleDouble{-b.high, -b.low};
}

/// DWTimesDW1: relative error below 8 u^2.
DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble p = two_product(a.high, b.high);
  return fast_two_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

template <typename T>
struct Vector {
  T x, y;
};

template <typename T>
T square(const Vector<T>& v) {
  return v.x * v.x + v.y * v.y;
}

template <typename T>
T cross(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.y - a.y * b.x;
}

Vector<DoubleDouble> exact_difference(const Point<2>& a, const Point<2>& b) {
  return {two_sum(a[0], -b[0]), two_sum(a[1], -b[1])};
}

Vector<std::int64_t> integer_difference(const Point<2>& a, const Point<2>& b) {
  return {static_cast<std::int64_t>(a[0] - b[0]), static_cast<std::int64_t>(a[1] - b[1])};
}

double largest_square_of(const WorkingPoints& points, const Quad& quad) {
  const Pair query = pair_of(points.scaled[quad.query]);
  return largest_square(corner_at(points.scaled[quad.a], query),
                        corner_at(points.scaled[quad.b], query),
                        corner_at(points.scaled[quad.c], query));
}

/// Whether p lies between a and b, all on one line.
bool between(const Point<2>& a, const Point<2>& p, const Point<2>& b) {
  return (a < p && p < b) || (b < p && p < a);
}

/// An infinite triangle beyond the edge a -> b of the hull.
bool conflicts_beyond(const WorkingPoints& points, VertexId a, VertexId b, VertexId query) {
  const int side = side_of_line(points, a, b, query);
  if (side != 0) return side > 0;
  return between(points.original(a), points.original(query), points.original(b));
}

}  // namespace

std::optional<int> in_circle_filtered(const WorkingPoints& points, const Quad& quad) {
  const Pair query = pair_of(points.scaled[quad.query]);
  const Corner a = corner_at(points.scaled[quad.a], query);
  const Corner b = corner_at(points.scaled[quad.b], query);
  const Corner c = corner_at(points.scaled[quad.c], query);
  const double ab = a.at[0] * b.at[1];
  const double ba = a.at[1] * b.at[0];
  const double bc = b.at[0] * c.at[1];
  const double cb = b.at[1] * c.at[0];
  const double ca = c.at[0] * a.at[1];
  const double ac = c.at[1] * a.at[0];
  const double determinant = a.square * (bc - cb) + b.square * (ca - ac) + c.square * (ab - ba);
  const double sum = a.square * (std::abs(bc) + std::abs(cb)) +
                     b.square * (std::abs(ca) + std::abs(ac)) +
                     c.square * (std::abs(ab) + std::abs(ba));
  const double bound = 12 * stages::kRoundoff * sum + kUnderflow;
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return std::nullopt;
}

std::optional<int> in_circle_double_double(const WorkingPoints& points, const Quad& quad) {
  const double largest = largest_square_of(points, quad);
  if (!(largest >= 0x1p-200 && largest <= 0x1p200)) return std::nullopt;
  const Point<2>& query = points.scaled[quad.query];
  const auto a = exact_difference(points.scaled[quad.a], query);
  const auto b = exact_difference(points.scaled[quad.b], query);
  const auto c = exact_difference(points.scaled[quad.c], query);
  const double determinant =
      (square(a) * cross(b, c) + square(b) * cross(c, a) + square(c) * cross(a, b)).high;
  const double bound = 192 * stages::kRoundoff * stages::kRoundoff * (largest * largest);
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return std::nullopt;
}

std::optional<int> in_circle_integer(const WorkingPoints& points, const Quad& quad) {
  if (!(largest_square_of(points, quad) <= 0x1p61)) return std::nullopt;
  using stages::Int128;
  const Point<2>& query = points.scaled[quad.query];
  const auto a = integer_difference(points.scaled[quad.a], query);
  const auto b = integer_difference(points.scaled[quad.b], query);
  const auto c = integer_difference(points.scaled[quad.c], query);
  return stages::sign(Int128{square(a)} * cross(b, c) + Int128{square(b)} * cross(c, a) +
                      Int128{square(c)} * cross(a, b));
}

bool is_rectangle(const WorkingPoints& points, const Quad& quad) {
  const Point<2>& a = points.original(quad.a);
  const Point<2>& b = points.original(quad.b);
  const Point<2>& c = points.original(quad.c);
  const Point<2>& q = points.original(quad.query);
  return (a[0] == b[0] && c[0] == q[0] && b[1] == c[1] && a[1] == q[1]) ||
         (a[1] == b[1] && c[1] == q[1] && b[0] == c[0] && a[0] == q[0]);
}

int side_of_circle(const WorkingPoints& points, const Quad& quad) {
  if (points.lattice) {
    if (const auto side = in_circle_integer(points, quad)) return *side;
  } else {
    if (const auto side = in_circle_filtered(points, quad)) return *side;
    if (is_rectangle(points, quad)) return 0;
    if (const auto side = in_circle_double_double(points, quad)) return *side;
  }
  return stages::exact<stages::InSphere<2>>({points.original(quad.a), points.original(quad.b),
                                             points.original(quad.c), points.original(quad.query)});
}

int side_of_line(const WorkingPoints& points, VertexId a, VertexId b, VertexId query) {
  const Pair origin = pair_of(points.scaled[query]);
  const Corner ca = corner_at(points.scaled[a], origin);
  const Corner cb = corner_at(points.scaled[b], origin);
  const double determinant = cross(ca, cb);
  if (std::abs(determinant) > cross_bound(std::max(ca.square, cb.square))) {
    return determinant > 0 ? 1 : -1;
  }
  const Point<2>& pa = points.original(a);
  const Point<2>& pb = points.original(b);
  const Point<2>& q = points.original(query);
  // A difference has the right sign even where it is rounded, so this decides many a tie.
  const int plus = stages::sign(pa[0] - q[0]) * stages::sign(pb[1] - q[1]);
  const int minus = stages::sign(pa[1] - q[1]) * stages::sign(pb[0] - q[0]);
  if (plus != minus) return plus > minus ? 1 : -1;
  if (plus == 0) return 0;
  return orientation<2>({pa, pb, q});
}

bool conflicts(const WorkingPoints& points, const Quad& quad) {
  const auto [a, b, c, query] = quad;
  if (a == kInfinite) return conflicts_beyond(points, b, c, query);
  if (b == kInfinite) return conflicts_beyond(points, c, a, query);
  if (c == kInfinite) return conflicts_beyond(points, a, b, query);
  const int side = side_of_circle(points, quad);
  if (side != 0) return side > 0;
  const auto larger = [&points](VertexId v, VertexId w) {
    return std::max(points.original(v), points.original(w));
  };
  return larger(a, c) > larger(b, query);
}

}  // namespace spillway::delaunay::kernel_2d

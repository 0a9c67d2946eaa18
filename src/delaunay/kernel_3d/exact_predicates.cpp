#include "src/delaunay/kernel_3d/exact_predicates.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "src/delaunay/kernel_3d/wide_integer.h"
#include "src/delaunay/kernel_common/lanes.h"
#include "src/geometry/predicate_stages.h"

namespace spillway::delaunay::kernel_3d {
namespace {

/// What underflow may add to the errors, in coordinates of extent 1 to 2.
constexpr double kUnderflow = 0x1p-1000;
/// The determinants' errors over the sums of their monomials' absolute values.
constexpr double kInSphereError = 20 * stages::kRoundoff;
constexpr double kOrientationError = 10 * stages::kRoundoff;
/// The same of the corrected determinant, for what is left after its lifts' rounding.
constexpr double kCorrectedError = 20 * stages::kRoundoff;
/// The error of a residual, over the squares that it is the difference of.
constexpr double kResidualError = 64 * stages::kRoundoff * stages::kRoundoff;
/// On a lattice nothing is rounded while those sums are below.
constexpr double kExactSum = 0x1p53;

/// A polynomial, rounded, and the sum of its monomials' absolute values, rounded.
struct Rounded {
  double value;
  double sum;

  friend Rounded operator+(const Rounded& a, const Rounded& b) {
    return {a.value + b.value, a.sum + b.sum};
  }
  friend Rounded operator-(const Rounded& a, const Rounded& b) {
    return {a.value - b.value, a.sum + b.sum};
  }
  friend Rounded operator*(const Rounded& a, const Rounded& b) {
    return {a.value * b.value, a.sum * b.sum};
  }
};

/// Three components, of any kind of number.
template <typename T>
struct Vector {
  T x, y, z;
};

template <typename T>
SPILLWAY_INLINE auto minor_xy(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.y - a.y * b.x;
}

template <typename T>
SPILLWAY_INLINE auto squared_length(const Vector<T>& v) {
  return v.x * v.x + v.y * v.y + v.z * v.z;
}

template <typename T>
SPILLWAY_INLINE auto orientation_determinant(const Vector<T>& a, const Vector<T>& b,
                                             const Vector<T>& c) {
  return minor_xy(b, c) * a.z - minor_xy(a, c) * b.z + minor_xy(a, b) * c.z;
}

/// What the in-sphere determinant of four vectors is made of: for each of them the determinant of
/// the others.
template <typename T>
SPILLWAY_INLINE auto minors_of(const std::array<Vector<T>, 4>& v) {
  const auto& [a, b, c, d] = v;
  const auto ab = minor_xy(a, b);
  const auto ac = minor_xy(a, c);
  const auto ad = minor_xy(a, d);
  const auto bc = minor_xy(b, c);
  const auto bd = minor_xy(b, d);
  const auto cd = minor_xy(c, d);
  return std::array{cd * b.z - bd * c.z + bc * d.z, cd * a.z - ad * c.z + ac * d.z,
                    bd * a.z - ad * b.z + ab * d.z, bc * a.z - ac * b.z + ab * c.z};
}

/// The in-sphere determinant, if the vectors are lifted by these numbers: their squared lengths,
/// or others that differ from those by an affine function of the point.
template <typename M, typename L>
SPILLWAY_INLINE auto lifted_determinant(const std::array<M, 4>& minors,
                                        const std::array<L, 4>& lifts) {
  return minors[0] * lifts[0] - minors[1] * lifts[1] + minors[2] * lifts[2] - minors[3] * lifts[3];
}

template <typename T>
SPILLWAY_INLINE auto squared_lengths(const std::array<Vector<T>, 4>& v) {
  return std::array{squared_length(v[0]), squared_length(v[1]), squared_length(v[2]),
                    squared_length(v[3])};
}

/// For each lane, how far a point is outside of a sphere, nearly: the difference of squares, as if
/// computed with twice the precision.
template <typename R>
struct Residual {
  R value;
  R squares;  ///< the sum of what it is the difference of

  /// The sphere is three coordinates and a squared radius.
  SPILLWAY_INLINE Residual(const R& x, const R& y, const R& z, const double* sphere) {
    const std::array<const R*, 3> point{&x, &y, &z};
    R sum{};
    R rest{};
    for (int k = 0; k < 3; ++k) {
      R difference, lost, square, lost_of_square;
      add(*point[k], R{} - sphere[k], difference, lost);
      multiply(difference, difference, square, lost_of_square);
      R next, lost_of_sum;
      add(sum, square, next, lost_of_sum);
      sum = next;
      rest += lost_of_square + 2 * difference * lost + lost_of_sum;
    }
    R difference, lost;
    add(sum, R{} - sphere[3], difference, lost);
    value = difference + (rest + lost);
    squares = sum + sphere[3];
  }

 private:
  /// A sum and what its rounding lost (D. Knuth).
  SPILLWAY_INLINE static void add(const R& a, const R& b, R& sum, R& lost) {
    sum = a + b;
    const R b_in_sum = sum - a;
    lost = (a - (sum - b_in_sum)) + (b - b_in_sum);
  }

  /// A product and what its rounding lost (T. Dekker, with G. Veltkamp's halves).
  SPILLWAY_INLINE static void multiply(const R& a, const R& b, R& product, R& lost) {
    constexpr double kSplitter = 0x1p27 + 1;
    const auto high_half = [](const R& x) {
      const R scaled = x * kSplitter;
      return scaled - (scaled - x);
    };
    const R a_high = high_half(a);
    const R b_high = high_half(b);
    const R a_low = a - a_high;
    const R b_low = b - b_high;
    product = a * b;
    lost = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
  }
};

Vector<Rounded> rounded_difference(const double* a, const double* b) {
  const auto component = [&](int k) {
    const double difference = a[k] - b[k];
    return Rounded{difference, std::abs(difference)};
  };
  return {component(0), component(1), component(2)};
}

/// The sign of a determinant, if it is certain.
std::optional<int> certain_sign(const WorkingPoints& points, const Rounded& determinant,
                                double error) {
  if (points.lattice && determinant.sum < kExactSum) return stages::sign(determinant.value);
  const double bound = error * determinant.sum + kUnderflow;
  if (determinant.value > bound) return 1;
  if (determinant.value < -bound) return -1;
  return std::nullopt;
}

/// A cell's vertices, seen from the query.
SPILLWAY_INLINE std::array<Vector<Rounded>, 4> rounded_differences(const WorkingPoints& points,
                                                                   const Five& five) {
  const auto at = [&](int i) {
    return rounded_difference(points.at(five.cell[i]), points.at(five.query));
  };
  return {at(0), at(1), at(2), at(3)};
}

/// in_sphere_filtered()
SPILLWAY_INLINE std::optional<int> filtered(const WorkingPoints& points,
                                            const std::array<Vector<Rounded>, 4>& differences,
                                            const std::array<Rounded, 4>& minors) {
  return certain_sign(points, lifted_determinant(minors, squared_lengths(differences)),
                      kInSphereError);
}

/// in_sphere_corrected()
SPILLWAY_INLINE std::optional<int> corrected(const WorkingPoints& points, const Five& five,
                                             const std::array<Rounded, 4>& minors,
                                             const double* sphere) {
  const double* const query = points.at(five.query);
  const Residual<double> of_query(query[0], query[1], query[2], sphere);
  std::array<Rounded, 4> lifts;
  for (int i = 0; i < 4; i += 2) {
    const Records<2> two = gather<2>([&](int k) { return points.at(five.cell[i + k]); });
    const Residual<Reals<2>> of_two(two.x, two.y, two.z, sphere);
    for (int k = 0; k < 2; ++k) {
      const double magnitudes = std::abs(of_two.value[k]) + std::abs(of_query.value);
      const double squares = of_two.squares[k] + of_query.squares;
      lifts[i + k] = {of_two.value[k] - of_query.value,
                      magnitudes * kCorrectedError + squares * kResidualError};
    }
  }
  const Rounded determinant = lifted_determinant(minors, lifts);
  const double bound = determinant.sum + kUnderflow;
  if (determinant.value > bound) return 1;
  if (determinant.value < -bound) return -1;
  return std::nullopt;
}

template <int kLimbs>
SPILLWAY_INLINE Vector<WideInteger<kLimbs>> operator-(const Vector<WideInteger<kLimbs>>& a,
                                                      const Vector<WideInteger<kLimbs>>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// The coordinates that exact stages compute with.
Point<3> exact_point(const WorkingPoints& points, VertexRef v) {
  if (!points.lattice) return points.original(v);
  const double* p = points.at(v);
  return {p[0], p[1], p[2]};
}

/// Turns points into integers of kLimbs limbs, all multiplied by the same power of two.
template <int kLimbs>
class IntegerPoints {
 public:
  template <std::size_t kCount>
  explicit IntegerPoints(const std::array<Point<3>, kCount>& points) {
    constexpr int kLargestExponent = 1000;  // for a power of two that is a normal number
    constexpr int kMantissaBits = 52;
    constexpr int kBias = 1023;
    double largest = 0;
    for (const Point<3>& p : points) {
      for (const double c : p) largest = std::max(largest, std::abs(c));
    }
    const int exponent =
        kBits - 1 -
        (static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> kMantissaBits) - kBias);
    exact_ = std::abs(exponent) <= kLargestExponent;
    if (exact_) {
      scale_ = std::bit_cast<double>(static_cast<std::uint64_t>(exponent + kBias) << kMantissaBits);
    }
  }

  /// Whether all points so far were multiples of the power of two.
  [[nodiscard]] bool exact() const { return exact_; }

  /// Not to be asked for if it is not exact already.
  Vector<WideInteger<kLimbs>> operator()(const Point<3>& p) {
    return {integer(p[0]), integer(p[1]), integer(p[2])};
  }

 private:
  static constexpr int kHalfBits = 62;
  /// Of each coordinate, so that their differences are below a quarter of what fits.
  static constexpr int kBits = kLimbs == 1 ? kHalfBits - 1 : 2 * kHalfBits + 1;

  WideInteger<kLimbs> integer(double coordinate) {
    const double scaled = coordinate * scale_;
    exact_ &= scaled != 0 || coordinate == 0;  // what underflows to another number is no integer
    if constexpr (kLimbs == 1) {
      return {{static_cast<std::uint64_t>(whole(scaled))}};
    } else {
      constexpr auto kHalf = static_cast<double>(std::int64_t{1} << kHalfBits);
      const auto high = static_cast<std::int64_t>(scaled * (1 / kHalf));
      const std::int64_t low = whole(scaled - static_cast<double>(high) * kHalf);
      const auto sum =
          static_cast<Uint128>(stages::Int128{high} * (std::int64_t{1} << kHalfBits) + low);
      return {{static_cast<std::uint64_t>(sum), static_cast<std::uint64_t>(sum >> 64)}};
    }
  }

  std::int64_t whole(double value) {
    const auto integer = static_cast<std::int64_t>(value);
    exact_ &= static_cast<double>(integer) == value;
    return integer;
  }

  double scale_ = 0;
  bool exact_;
};

std::array<Point<3>, 5> exact_points(const WorkingPoints& points, const Five& five) {
  const auto at = [&](VertexRef v) { return exact_point(points, v); };
  return {at(five.cell[0]), at(five.cell[1]), at(five.cell[2]), at(five.cell[3]), at(five.query)};
}

std::array<Point<3>, 4> exact_points(const WorkingPoints& points,
                                     const std::array<VertexRef, 4>& p) {
  const auto at = [&](VertexRef v) { return exact_point(points, v); };
  return {at(p[0]), at(p[1]), at(p[2]), at(p[3])};
}

}  // namespace

std::optional<int> in_sphere_filtered(const WorkingPoints& points, const Five& five) {
  const auto differences = rounded_differences(points, five);
  return filtered(points, differences, minors_of(differences));
}

std::optional<int> in_sphere_corrected(const WorkingPoints& points, const Five& five,
                                       const double* sphere) {
  return corrected(points, five, minors_of(rounded_differences(points, five)), sphere);
}

std::optional<int> orientation_filtered(const WorkingPoints& points,
                                        const std::array<VertexRef, 4>& p) {
  const double* origin = points.at(p[0]);
  const auto at = [&](int i) { return rounded_difference(points.at(p[i]), origin); };
  return certain_sign(points, orientation_determinant(at(1), at(2), at(3)), kOrientationError);
}

template <int kLimbs>
std::optional<int> in_sphere_integer(const WorkingPoints& points, const Five& five) {
  const std::array<Point<3>, 5> p = exact_points(points, five);
  IntegerPoints<kLimbs> integers(p);
  if (!integers.exact()) return std::nullopt;
  const auto query = integers(p[4]);
  const auto a = integers(p[0]) - query;
  const auto b = integers(p[1]) - query;
  const auto c = integers(p[2]) - query;
  const auto d = integers(p[3]) - query;
  if (!integers.exact()) return std::nullopt;
  const std::array vectors{a, b, c, d};
  return sign(lifted_determinant(minors_of(vectors), squared_lengths(vectors)));
}

template <int kLimbs>
std::optional<int> orientation_integer(const WorkingPoints& points,
                                       const std::array<VertexRef, 4>& p) {
  const std::array<Point<3>, 4> exact = exact_points(points, p);
  IntegerPoints<kLimbs> integers(exact);
  if (!integers.exact()) return std::nullopt;
  const auto origin = integers(exact[0]);
  const auto a = integers(exact[1]) - origin;
  const auto b = integers(exact[2]) - origin;
  const auto c = integers(exact[3]) - origin;
  if (!integers.exact()) return std::nullopt;
  return sign(orientation_determinant(a, b, c));
}

template std::optional<int> in_sphere_integer<1>(const WorkingPoints&, const Five&);
template std::optional<int> in_sphere_integer<2>(const WorkingPoints&, const Five&);
template std::optional<int> orientation_integer<1>(const WorkingPoints&,
                                                   const std::array<VertexRef, 4>&);
template std::optional<int> orientation_integer<2>(const WorkingPoints&,
                                                   const std::array<VertexRef, 4>&);

int side_of_sphere(const WorkingPoints& points, const Five& five, const double* sphere) {
  const auto differences = rounded_differences(points, five);
  const auto minors = minors_of(differences);
  if (const auto side = filtered(points, differences, minors)) return *side;
  if (const auto side = corrected(points, five, minors, sphere)) return *side;
  if (const auto side = in_sphere_integer<1>(points, five)) return *side;
  if (const auto side = in_sphere_integer<2>(points, five)) return *side;
  return stages::exact<stages::InSphere<3>>(exact_points(points, five));
}

int orientation(const WorkingPoints& points, const std::array<VertexRef, 4>& p) {
  if (const auto side = orientation_filtered(points, p)) return *side;
  if (const auto side = orientation_integer<1>(points, p)) return *side;
  if (const auto side = orientation_integer<2>(points, p)) return *side;
  return stages::exact<stages::Orientation<3>>(exact_points(points, p));
}

bool tie_conflicts(const WorkingPoints& points, const Five& five) {
  const auto larger = [&points](VertexRef v, VertexRef w) {
    return points.has_order_keys ? points.at(v)[3] > points.at(w)[3]
                                 : points.original(v) > points.original(w);
  };
  std::array<int, 4> largest_first{0, 1, 2, 3};
  std::sort(largest_first.begin(), largest_first.end(),
            [&](int i, int j) { return larger(five.cell[i], five.cell[j]); });
  for (const int i : largest_first) {
    if (larger(five.query, five.cell[i])) return false;
    std::array<VertexRef, 4> replaced = five.cell;
    replaced[i] = five.query;
    if (const int coefficient = orientation(points, replaced)) return coefficient > 0;
  }
  return false;
}

}  // namespace spillway::delaunay::kernel_3d

#include "src/geometry/constructions/circumsphere.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/geometry/determinants.h"
#include "src/geometry/dimensions.h"

namespace spillway::geometry {
namespace {

// The names are those of docs/algorithm-predicates.md ("Certified balls").
constexpr double kRoundoff = 0x1p-53;  // u
template <int D>
constexpr double kGamma = (D <= 3 ? 16 : 64) * kRoundoff;  // above all relative errors of monomials
constexpr double kUnderflow = 0x1p-700;                    // above all that underflow can lose
template <int D>
constexpr double kSmallestSafe = D <= 3 ? 0x1p-150 : 0x1p-60;
template <int D>
constexpr double kLargestSafe = 1 / kSmallestSafe<D>;
constexpr double kLargestCentre = 0x1p400;
constexpr double kErrorSlack = 1 + 0x1p-40;   // for the roundings of the error bound itself
constexpr double kRadiusSlack = 1 + 0x1p-48;  // 1 + 32u, for those of may_meet

// The names are those of "Many balls at once".
constexpr double kFlat = 0x1p-30;
constexpr double kShortestEdge = 0x1p-60;
constexpr double kLongestEdge = 0x1p60;
constexpr double kMargin = 1 + 0x1p-10;                // of the squared radius
constexpr double kNumeratorError = 288 * kRoundoff;    // over L^(D+1)
constexpr double kDenominatorError = 192 * kRoundoff;  // over L^D

// A determinant, rounded, and the sum of the absolute values of its monomials, rounded.
struct Rounded {
  double value;
  double magnitude;

  Rounded& operator+=(const Rounded& other) {
    value += other.value;
    magnitude += other.magnitude;
    return *this;
  }
  friend Rounded operator*(double factor, const Rounded& r) {
    return {factor * r.value, std::abs(factor) * r.magnitude};
  }
};

Rounded minor(double a, double b, double c, double d) {
  const double ad = a * d;
  const double bc = b * c;
  return {ad - bc, std::abs(ad) + std::abs(bc)};
}

// The circumcentre is numerator / denominator, component by component.
template <int D>
struct Quotient {
  std::array<Rounded, D> numerator;
  Rounded denominator;
};

Quotient<2> circumcentre(const Vectors<2, 2, double>& a) {
  const double s0 = squared_length(a[0]);
  const double s1 = squared_length(a[1]);
  return {{minor(s0, a[0][1], s1, a[1][1]), minor(a[0][0], s0, a[1][0], s1)},
          2 * minor(a[0][0], a[0][1], a[1][0], a[1][1])};
}

Quotient<3> circumcentre(const Vectors<3, 3, double>& a) {
  Quotient<3> q{};
  for (int i = 0; i < 3; ++i) {
    const auto& b = a[(i + 1) % 3];
    const auto& c = a[(i + 2) % 3];
    const std::array<Rounded, 3> cross{minor(b[1], b[2], c[1], c[2]), minor(b[2], b[0], c[2], c[0]),
                                       minor(b[0], b[1], c[0], c[1])};
    const double s = squared_length(a[i]);
    for (int k = 0; k < 3; ++k) q.numerator[k] += s * cross[k];
    if (i == 0) {
      for (int k = 0; k < 3; ++k) q.denominator += 2 * a[0][k] * cross[k];
    }
  }
  return q;
}

// Cramer's rule: the edges' rows are continued by their squared lengths.
template <std::size_t D>
requires(D > 3) Quotient<D> circumcentre(const std::array<std::array<double, D>, D>& a) {
  Vectors<D + 1, D, double> rows;
  Vectors<D + 1, D, double> sizes;
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t k = 0; k < D; ++k) rows[i][k] = a[i][k];
    rows[i][D] = squared_length(a[i]);
    for (std::size_t k = 0; k <= D; ++k) sizes[i][k] = std::abs(rows[i][k]);
  }
  const auto values = minors(rows);
  const auto magnitudes = minors<false>(sizes);
  constexpr unsigned kAxes = (1U << D) - 1;
  Quotient<D> q;
  q.denominator = {2 * values[kAxes], 2 * magnitudes[kAxes]};
  for (std::size_t k = 0; k < D; ++k) {
    const unsigned replaced = (kAxes ^ 1U << k) | 1U << D;
    q.numerator[k] = {(D - 1 - k) % 2 == 0 ? values[replaced] : -values[replaced],
                      magnitudes[replaced]};
  }
  return q;
}

// What follows is for loops over several simplices at once: no branches, and no std::max, which
// hands out references.
double larger(double a, double b) { return a < b ? b : a; }
double smaller(double a, double b) { return b < a ? b : a; }

// The circumcentre's numerators, and last its denominator, without bounds.
[[gnu::always_inline]] inline std::array<double, 3> circumcentre_fraction(
    const Vectors<2, 2, double>& a) {
  const double s0 = squared_length(a[0]);
  const double s1 = squared_length(a[1]);
  return {s0 * a[1][1] - s1 * a[0][1], s1 * a[0][0] - s0 * a[1][0], 2 * minor_xy(a[0], a[1])};
}

[[gnu::always_inline]] inline std::array<double, 4> circumcentre_fraction(
    const Vectors<3, 3, double>& a) {
  std::array<double, 4> fraction{};
  for (int i = 0; i < 3; ++i) {
    const auto& b = a[(i + 1) % 3];
    const auto& c = a[(i + 2) % 3];
    const std::array<double, 3> cross{b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2],
                                      b[0] * c[1] - b[1] * c[0]};
    const double s = squared_length(a[i]);
    for (int k = 0; k < 3; ++k) fraction[k] += s * cross[k];
    if (i == 0) fraction[3] = 2 * (a[0][0] * cross[0] + a[0][1] * cross[1] + a[0][2] * cross[2]);
  }
  return fraction;
}

template <int D>
struct Edges {
  Vectors<D, D, double> vectors;  // from the first corner
  double longest = 0;             // magnitude of a component: L

  explicit Edges(const std::array<Point<D>, D + 1>& simplex) {
    for (int i = 0; i < D; ++i) {
      for (int k = 0; k < D; ++k) {
        vectors[i][k] = simplex[i + 1][k] - simplex[0][k];
        longest = larger(longest, std::abs(vectors[i][k]));
      }
    }
  }

  [[nodiscard]] double volume() const {
    return D == 2 ? longest * longest : longest * longest * longest;
  }
  // Positive if L is in the range that the proofs cover; NaN never is.
  [[nodiscard]] double range() const {
    return smaller(longest - kShortestEdge, kLongestEdge - longest);
  }
};

template <int D>
std::array<Point<D>, D + 1> corners_in(const SimplexBatch<D>& simplices, std::size_t s) {
  std::array<Point<D>, D + 1> simplex;
  for (int i = 0; i <= D; ++i) {
    for (int k = 0; k < D; ++k) simplex[i][k] = simplices.corners[i][k][s];
  }
  return simplex;
}

// The names are those of docs/algorithm-predicates.md ("Many balls at once"). Positive if the
// circumsphere is certainly inside.
template <int D>
double room_around(const std::array<Point<D>, D + 1>& simplex, const Box<D>& box) {
  const Edges<D> edges(simplex);
  const std::array<double, D + 1> fraction = circumcentre_fraction(edges.vectors);
  const double sign = fraction[D] < 0 ? -1 : 1;
  const double denominator = std::abs(fraction[D]);
  double squared_radius = 0;
  double room = 0;
  for (int k = 0; k < D; ++k) {
    const double centre = sign * fraction[k];
    const double below = (simplex[0][k] - box.lo[k]) * denominator + centre;
    const double above = (box.hi[k] - simplex[0][k]) * denominator - centre;
    squared_radius += centre * centre;
    room = k == 0 ? smaller(below, above) : smaller(room, smaller(below, above));
  }
  const double shape = denominator - kFlat * edges.volume();
  // The first two are not positive where the last proves nothing, or are NaN and stay it.
  return smaller(smaller(shape, edges.range()), room * std::abs(room) - kMargin * squared_radius);
}

// The circumcentre of a simplex, its squared radius and its error, as in CertifiedBall, if proved.
template <int D>
struct RoughSphere {
  Point<D> centre;
  double squared_radius = 0;
  double error = 0;
  double proved = 0;  // if positive

  explicit RoughSphere(const std::array<Point<D>, D + 1>& simplex) {
    const Edges<D> edges(simplex);
    const std::array<double, D + 1> fraction = circumcentre_fraction(edges.vectors);
    const double inverse = 1 / fraction[D];
    double farthest = 0;
    for (int k = 0; k < D; ++k) {
      centre[k] = fraction[k] * inverse;
      farthest = larger(farthest, std::abs(centre[k]));
    }
    const double volume = edges.volume();
    const double denominator_error = kDenominatorError * volume;
    const double denominator = std::abs(fraction[D]) - denominator_error;
    const double numerator_error = kNumeratorError * volume * edges.longest;
    error = kErrorSlack * ((numerator_error + farthest * denominator_error) / denominator +
                           6 * kRoundoff * farthest);
    for (int k = 0; k < D; ++k) {
      const double most = std::abs(centre[k]) + error;
      squared_radius += most * most;
    }
    squared_radius *= kRadiusSlack;
    // NaN in the first stays.
    proved = smaller(denominator - denominator_error, edges.range());
  }
};

// Balls in lanes, two or four at a time. Written out, as compilers make branches of the choices.
template <int kLanes>
struct Lanes;
template <>
struct Lanes<2> {
  using Reals [[gnu::vector_size(16)]] = double;
  using Bits [[gnu::vector_size(16)]] = std::uint64_t;
  static constexpr Bits kPlaces{0, 1};
};
template <>
struct Lanes<4> {
  using Reals [[gnu::vector_size(32)]] = double;
  using Bits [[gnu::vector_size(32)]] = std::uint64_t;
  static constexpr Bits kPlaces{0, 1, 2, 3};
};

// How far a box is at least from a ball's centre on an axis: of one ball, or of those in lanes.
template <typename Number>
[[gnu::always_inline]] inline void add_gap(double lo, double hi, const Number& anchor,
                                           const Number& centre, const Number& error,
                                           Number& squared_distance) {
  const Number below = (lo - anchor) - centre;
  const Number above = centre - (hi - anchor);
  const Number outside = (below < above ? above : below) - error;
  const Number gap = Number{} < outside ? outside : Number{};
  squared_distance += gap * gap;
}

// A bit for each ball in the next lanes from s on that certainly misses the box, which is not
// empty.
template <int D, int kLanes>
[[gnu::always_inline]] inline void add_missed(const BallBatch<D>& balls, const Box<D>& box,
                                              std::size_t s, typename Lanes<kLanes>::Bits& missed) {
  using Reals = typename Lanes<kLanes>::Reals;
  using Bits = typename Lanes<kLanes>::Bits;
  Reals error, squared_radius;
  std::memcpy(&error, &balls.error[s], sizeof(Reals));
  std::memcpy(&squared_radius, &balls.squared_radius[s], sizeof(Reals));
  Reals squared_distance{};
  for (int k = 0; k < D; ++k) {
    Reals anchor, centre;
    std::memcpy(&anchor, &balls.anchor[k][s], sizeof(Reals));
    std::memcpy(&centre, &balls.centre[k][s], sizeof(Reals));
    add_gap(box.lo[k], box.hi[k], anchor, centre, error, squared_distance);
  }
  missed |=
      (Bits)(squared_distance > squared_radius) & ((Bits{} + 1) << (Lanes<kLanes>::kPlaces + s));
}

template <int D, int kLanes>
[[gnu::always_inline]] inline std::uint64_t may_meet_in_lanes(const BallBatch<D>& balls,
                                                              const Box<D>& box,
                                                              std::uint64_t asked) {
  constexpr std::size_t kTogether = 8;
  typename Lanes<kLanes>::Bits missed{};
  for (std::size_t begin = 0; begin < BallBatch<D>::kSize; begin += kTogether) {
    if ((asked >> begin & ((1U << kTogether) - 1)) == 0) continue;
    for (std::size_t s = begin; s < begin + kTogether; s += kLanes) {
      add_missed<D, kLanes>(balls, box, s, missed);
    }
  }
  for (int lane = 0; lane < kLanes; ++lane) asked &= ~missed[lane];
  return asked;
}

template <int D>
[[gnu::always_inline]] inline void certify_all(const SimplexBatch<D>& simplices,
                                               BallBatch<D>& balls) {
  constexpr std::size_t kSize = SimplexBatch<D>::kSize;
  // Arrays of its own, of which the compiler knows that they are no other's.
  std::array<std::array<double, kSize>, D> centre;
  std::array<double, kSize> squared_radius;
  std::array<double, kSize> error;
  std::array<double, kSize> proved;
  for (std::size_t s = 0; s < kSize; ++s) {
    const RoughSphere<D> sphere(corners_in(simplices, s));
    for (int k = 0; k < D; ++k) centre[k][s] = sphere.centre[k];
    squared_radius[s] = sphere.squared_radius;
    error[s] = sphere.error;
    proved[s] = sphere.proved;
  }
  for (std::size_t s = 0; s < kSize; ++s) {
    balls.squared_radius[s] = proved[s] > 0 ? squared_radius[s] : CertifiedBall<D>{}.squared_radius;
    balls.error[s] = proved[s] > 0 ? error[s] : CertifiedBall<D>{}.error;
  }
  balls.centre = centre;
  balls.anchor = simplices.corners[0];
}

// The same for processors with AVX2, which have four lanes. Every operation is rounded alike, so
// the results are the same to the bit.
#ifdef __x86_64__
template <int D>
[[gnu::target("avx2")]] std::uint64_t may_meet_with_avx2(const BallBatch<D>& balls,
                                                         const Box<D>& box, std::uint64_t asked) {
  return may_meet_in_lanes<D, 4>(balls, box, asked);
}

template <int D>
[[gnu::target("avx2")]] void certify_with_avx2(const SimplexBatch<D>& simplices,
                                               BallBatch<D>& balls) {
  certify_all<D>(simplices, balls);
}

const bool has_avx2 = static_cast<bool>(__builtin_cpu_supports("avx2"));
#endif

}  // namespace

template <int D>
CertifiedBall<D> certified_ball(const std::array<Point<D>, D + 1>& simplex) {
  CertifiedBall<D> ball{.anchor = simplex[0], .centre = {}};
  Vectors<D, D, double> edges;
  double longest = 0;
  for (int i = 0; i < D; ++i) {
    for (int k = 0; k < D; ++k) {
      edges[i][k] = simplex[i + 1][k] - simplex[0][k];
      longest = std::max(longest, std::abs(edges[i][k]));
    }
  }
  const Quotient<D> q = circumcentre(edges);
  const double denominator = std::abs(q.denominator.value);
  const double denominator_error = kGamma<D> * q.denominator.magnitude + kUnderflow;
  double numerator_error = 0;
  double farthest = 0;
  for (int k = 0; k < D; ++k) {
    ball.centre[k] = q.numerator[k].value / q.denominator.value;
    numerator_error = std::max(numerator_error, kGamma<D> * q.numerator[k].magnitude + kUnderflow);
    farthest = std::max(farthest, std::abs(ball.centre[k]));
  }
  // Written so that NaN fails.
  const bool proved = longest >= kSmallestSafe<D> && longest <= kLargestSafe<D> &&
                      denominator > 2 * denominator_error && farthest <= kLargestCentre;
  if (!proved) return ball;

  ball.error = kErrorSlack * ((numerator_error + farthest * denominator_error) /
                                  (denominator - denominator_error) +
                              4 * kRoundoff * farthest);
  double squared_radius = 0;
  for (int k = 0; k < D; ++k) {
    const double most = std::abs(ball.centre[k]) + ball.error;
    squared_radius += most * most;
  }
  ball.squared_radius = kRadiusSlack * squared_radius;
  return ball;
}

// Whether the ball certainly lies inside, and touches no side. Written so that NaN fails.
template <int D>
bool is_inside(const CertifiedBall<D>& ball, const Box<D>& box) {
  constexpr double kRounding = 0x1p-50;
  for (int k = 0; k < D; ++k) {
    // Sides may be infinite.
    const double error = ball.error + kRounding * std::abs(ball.centre[k]);
    const double below = (ball.anchor[k] - box.lo[k]) * (1 - kRounding) + ball.centre[k];
    const double above = (box.hi[k] - ball.anchor[k]) * (1 - kRounding) - ball.centre[k];
    const double room = std::min(below, above) - error;
    if (!(room > 0 && room * room > kMargin * ball.squared_radius)) return false;
  }
  return true;
}

template <int D>
bool may_meet(const CertifiedBall<D>& ball, const Box<D>& box) {
  if (box.empty()) return false;
  double squared_distance = 0;
  for (int k = 0; k < D; ++k) {
    add_gap(box.lo[k], box.hi[k], ball.anchor[k], ball.centre[k], ball.error, squared_distance);
  }
  return !(squared_distance > ball.squared_radius);
}

template <int D>
std::array<bool, SimplexBatch<D>::kSize> well_inside(const SimplexBatch<D>& simplices,
                                                     const Box<D>& box) {
  constexpr std::size_t kSize = SimplexBatch<D>::kSize;
  if constexpr (D > 3) {
    std::array<bool, kSize> result;
    for (std::size_t s = 0; s < kSize; ++s) {
      result[s] = is_inside(certified_ball<D>(corners_in(simplices, s)), box);
    }
    return result;
  } else {
    std::array<double, kSize> room;
    for (std::size_t s = 0; s < kSize; ++s) {
      room[s] = room_around<D>(corners_in(simplices, s), box);
    }
    std::array<bool, kSize> result;
    for (std::size_t s = 0; s < kSize; ++s) result[s] = room[s] > 0;
    return result;
  }
}

template <int D>
void certify(const SimplexBatch<D>& simplices, BallBatch<D>& balls) {
  if constexpr (D > 3) {
    for (std::size_t s = 0; s < SimplexBatch<D>::kSize; ++s) {
      balls.set(s, certified_ball<D>(corners_in(simplices, s)));
    }
    return;
  } else {
#ifdef __x86_64__
    if (has_avx2) return certify_with_avx2<D>(simplices, balls);
#endif
    certify_all<D>(simplices, balls);
  }
}

template <int D>
std::uint64_t may_meet(const BallBatch<D>& balls, const Box<D>& box, std::uint64_t asked) {
  if (box.empty() || asked == 0) return 0;
#ifdef __x86_64__
  if (has_avx2) return may_meet_with_avx2<D>(balls, box, asked);
#endif
  return may_meet_in_lanes<D, 2>(balls, box, asked);
}

#define SPILLWAY_INSTANTIATE(D)                                                            \
  template CertifiedBall<D> certified_ball<D>(const std::array<Point<D>, D + 1>&);         \
  template bool may_meet<D>(const CertifiedBall<D>&, const Box<D>&);                       \
  template std::array<bool, SimplexBatch<D>::kSize> well_inside<D>(const SimplexBatch<D>&, \
                                                                   const Box<D>&);         \
  template void certify<D>(const SimplexBatch<D>&, BallBatch<D>&);                         \
  template std::uint64_t may_meet<D>(const BallBatch<D>&, const Box<D>&, std::uint64_t);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::geometry

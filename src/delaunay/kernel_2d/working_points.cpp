#include "src/delaunay/kernel_2d/working_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "src/delaunay/kernel_2d/filters.h"
#include "src/geometry/box.h"

namespace spillway::kernel_2d {
namespace {

/// Multiplies by a power of two, which is exact unless the product is subnormal. In two steps,
/// because the powers reach from 2^-1024 to 2^1074.
class PowerOfTwo {
 public:
  explicit PowerOfTwo(int exponent)
      : half_(std::ldexp(1.0, exponent / 2)), rest_(std::ldexp(1.0, exponent - exponent / 2)) {}
  double operator*(double value) const { return value * half_ * rest_; }

 private:
  double half_, rest_;
};

Box<2> box_of(std::span<const Point<2>> points) {
  Box<2> box;
  for (const Point<2>& p : points) box.expand(p);
  return box;
}

/// A lattice that all points belong to: they are `corner` plus integers, over 2^exponent.
struct LatticeOfPoints {
  int exponent;       ///< the points times 2^exponent are integers below 2^52
  Point<2> corner;    ///< of the box, times 2^exponent
  int unit_exponent;  ///< differences to the corner are multiples of 2^unit_exponent
};

constexpr int kIntegerBits = 52;
/// Beyond, the power of two or its inverse is not a normal double.
constexpr int kLargestExponent = 1000;

std::optional<LatticeOfPoints> find_lattice(std::span<const Point<2>> points, const Box<2>& box) {
  double largest = 0;
  for (const Point<2>& p : {box.lo, box.hi}) {
    largest = std::max({largest, std::abs(p[0]), std::abs(p[1])});
  }
  const int exponent = kIntegerBits - 1 - std::ilogb(largest);
  if (std::abs(exponent) > kLargestExponent) return std::nullopt;
  const double scale = std::ldexp(1.0, exponent);
  const double inverse = std::ldexp(1.0, -exponent);
  const Point<2> corner{box.lo[0] * scale, box.lo[1] * scale};
  const auto corner_x = static_cast<std::int64_t>(corner[0]);
  const auto corner_y = static_cast<std::int64_t>(corner[1]);
  constexpr std::size_t kGrain = 256;  // so many points at a time, without a branch
  std::int64_t bits = 0;
  for (std::size_t begin = 0; begin < points.size(); begin += kGrain) {
    bool exact = true;
    for (const Point<2>& p : points.subspan(begin, std::min(kGrain, points.size() - begin))) {
      const auto x = static_cast<std::int64_t>(p[0] * scale);
      const auto y = static_cast<std::int64_t>(p[1] * scale);
      exact = exact & (static_cast<double>(x) * inverse == p[0]) &
              (static_cast<double>(y) * inverse == p[1]);
      bits |= (x - corner_x) | (y - corner_y);
    }
    if (!exact) return std::nullopt;
  }
  return LatticeOfPoints{exponent, corner, std::countr_zero(static_cast<std::uint64_t>(bits))};
}

}  // namespace

WorkingPoints make_working_points(std::span<const Point<2>> points, Block& memory) {
  auto* const scaled =
      static_cast<Point<2>*>(memory.reserve((points.size() + kFirstPoint) * sizeof(Point<2>)));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  scaled[kInfinite] = {kNan, kNan};
  WorkingPoints result{.scaled = scaled, .originals = points.data()};
  const Box<2> box = box_of(points);
  Point<2> extent;
  if (const auto lattice = find_lattice(points, box)) {
    result.lattice = true;
    const double scale = std::ldexp(1.0, lattice->exponent);
    const double per_unit = std::ldexp(1.0, -lattice->unit_exponent);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (int k = 0; k < 2; ++k) {
        scaled[i + kFirstPoint][k] = (points[i][k] * scale - lattice->corner[k]) * per_unit;
      }
    }
    for (int k = 0; k < 2; ++k) extent[k] = (box.hi[k] * scale - lattice->corner[k]) * per_unit;
  } else {
    const double longest = box.extent(box.longest_axis());
    const PowerOfTwo scale(std::isinf(longest) ? -std::numeric_limits<double>::max_exponent
                                               : -std::ilogb(longest));
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (int k = 0; k < 2; ++k) scaled[i + kFirstPoint][k] = scale * points[i][k];
    }
    for (int k = 0; k < 2; ++k) extent[k] = scale * box.hi[k] - scale * box.lo[k];
  }
  const double diagonal = extent[0] * extent[0] + extent[1] * extent[1];
  result.certain_determinant = in_circle_bound(diagonal);
  return result;
}

}  // namespace spillway::kernel_2d

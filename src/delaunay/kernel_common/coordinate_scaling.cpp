#include "src/delaunay/kernel_common/coordinate_scaling.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

#include "src/geometry/box.h"
#include "src/geometry/dimensions.h"

namespace spillway::delaunay {
namespace {

/// A lattice that all points belong to: they are `corner` plus integers, over 2^exponent.
template <int D>
struct LatticeOfPoints {
  int exponent;       ///< the points times 2^exponent are integers below 2^52
  Point<D> corner;    ///< of the box, times 2^exponent
  int unit_exponent;  ///< differences to the corner are multiples of 2^unit_exponent
};

constexpr int kIntegerBits = 52;
/// Beyond, the power of two or its inverse is not a normal double.
constexpr int kLargestExponent = 1000;

template <int D>
std::optional<LatticeOfPoints<D>> find_lattice(std::span<const Point<D>> points,
                                               const Box<D>& box) {
  double largest = 0;
  for (int k = 0; k < D; ++k) {
    largest = std::max({largest, std::abs(box.lo[k]), std::abs(box.hi[k])});
  }
  const int exponent = kIntegerBits - 1 - std::ilogb(largest);
  if (std::abs(exponent) > kLargestExponent) return std::nullopt;
  const double scale = std::ldexp(1.0, exponent);
  const double inverse = std::ldexp(1.0, -exponent);
  Point<D> corner;
  std::array<std::int64_t, D> whole_corner;
  for (int k = 0; k < D; ++k) {
    corner[k] = box.lo[k] * scale;
    whole_corner[k] = static_cast<std::int64_t>(corner[k]);
  }
  constexpr std::size_t kGrain = 256;  // points at a time, without a branch
  std::int64_t bits = 0;
  for (std::size_t begin = 0; begin < points.size(); begin += kGrain) {
    bool exact = true;
    for (const Point<D>& p : points.subspan(begin, std::min(kGrain, points.size() - begin))) {
      for (int k = 0; k < D; ++k) {
        const auto whole = static_cast<std::int64_t>(p[k] * scale);
        exact = exact & (static_cast<double>(whole) * inverse == p[k]);
        bits |= whole - whole_corner[k];
      }
    }
    if (!exact) return std::nullopt;
  }
  return LatticeOfPoints<D>{exponent, corner, std::countr_zero(static_cast<std::uint64_t>(bits))};
}

}  // namespace

template <int D>
CoordinateScaling<D>::CoordinateScaling(std::span<const Point<D>> points) {
  Box<D> box;
  for (const Point<D>& p : points) box.expand(p);
  if (const auto lattice = find_lattice<D>(points, box)) {
    lattice_ = true;
    first_ = std::ldexp(1.0, lattice->exponent);
    second_ = std::ldexp(1.0, -lattice->unit_exponent);
    corner_ = lattice->corner;
  } else {
    const double longest = box.extent(box.longest_axis());
    const int exponent =
        std::isinf(longest) ? -std::numeric_limits<double>::max_exponent : -std::ilogb(longest);
    first_ = std::ldexp(1.0, exponent / 2);
    second_ = std::ldexp(1.0, exponent - exponent / 2);
  }
  const Point<D> lo = (*this)(box.lo);
  const Point<D> hi = (*this)(box.hi);
  for (int k = 0; k < D; ++k) extent_[k] = hi[k] - lo[k];
}

#define SPILLWAY_INSTANTIATE(D) template class CoordinateScaling<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay

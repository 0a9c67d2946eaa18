// The last rung of the predicates, apart from the others because big integers compile slowly.

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>

#include "src/error.h"
#include "src/geometry/predicate_rungs.h"

namespace spillway::detail::rungs {
namespace {

// Signed integers of any size; those of ordinary coordinates need no memory from the heap.
using BigInt = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<512, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, std::allocator<int>>,
    boost::multiprecision::et_off>;

// A finite double as mantissa * 2^exponent.
struct Split {
  std::int64_t mantissa;
  int exponent;
};

Split split(double value) {
  if (!std::isfinite(value)) {
    throw Error("a coordinate is not a finite number: predicates are defined on finite ones only");
  }
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return {static_cast<std::int64_t>(std::ldexp(fraction, 53)), exponent - 53};
}

}  // namespace

template <typename P>
int exact(const Points<P>& points) {
  constexpr int D = P::kDimension;
  // All coordinates times one power of two are integers, and the sign stays the same.
  int lowest = std::numeric_limits<int>::max();
  for (const auto& point : points) {
    for (const double coordinate : point) {
      const Split s = split(coordinate);
      if (s.mantissa != 0) lowest = std::min(lowest, s.exponent);
    }
  }
  const auto scaled = [lowest](double coordinate) {
    const Split s = split(coordinate);
    return s.mantissa == 0 ? BigInt(0) : BigInt(BigInt(s.mantissa) << (s.exponent - lowest));
  };
  Vectors<D, P::kVectors, BigInt> v;
  for (int k = 0; k < D; ++k) {
    const BigInt origin = scaled(points[P::kOrigin][k]);
    for (int i = 0; i < P::kVectors; ++i) v[i][k] = scaled(points[source<P>(i)][k]) - origin;
  }
  return sign(P::determinant(v));
}

template int exact<Orientation<2>>(const Points<Orientation<2>>&);
template int exact<Orientation<3>>(const Points<Orientation<3>>&);
template int exact<InSphere<2>>(const Points<InSphere<2>>&);
template int exact<InSphere<3>>(const Points<InSphere<3>>&);

}  // namespace spillway::detail::rungs

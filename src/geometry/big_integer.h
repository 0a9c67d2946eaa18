#pragma once
// Integers of any size, for exact stages. Compiles slowly: for few source files only.

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "src/error.h"

namespace spillway::geometry {

/// A signed integer of any size; those of ordinary coordinates need no memory from the heap.
using BigInt = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<512, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, std::allocator<int>>,
    boost::multiprecision::et_off>;

/// A power of two that makes integers of all doubles it has been told of.
class CommonScale {
 public:
  /// Throws Failure if the value is not finite.
  void include(double value) {
    const Split s = split(value);
    if (s.mantissa != 0) exponent_ = std::min(exponent_, s.exponent);
  }

  template <typename Point>
  void include_point(const Point& point) {
    for (const double coordinate : point) include(coordinate);
  }

  /// value / 2^exponent(), of a value that has been included.
  [[nodiscard]] BigInt integer(double value) const {
    const Split s = split(value);
    return s.mantissa == 0 ? BigInt(0) : BigInt(BigInt(s.mantissa) << (s.exponent - exponent_));
  }

  /// Meaningful once a value other than 0 has been included.
  [[nodiscard]] int exponent() const { return exponent_; }

 private:
  // A finite double as mantissa * 2^exponent.
  struct Split {
    std::int64_t mantissa;
    int exponent;
  };

  static Split split(double value) {
    if (!std::isfinite(value)) {
      throw Failure(
          "a coordinate is not a finite number: predicates are defined on finite ones only",
          ErrorCode::kInvalidArgument);
    }
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);
    return {static_cast<std::int64_t>(std::ldexp(fraction, 53)), exponent - 53};
  }

  int exponent_ = std::numeric_limits<int>::max();
};

}  // namespace spillway::geometry

#include "src/generators/random.h"

#include <bit>
#include <cmath>

namespace spillway::generators {

double portable_log(double x) {
  // x = 2^exponent * mantissa with the mantissa around 1; then log(mantissa) is the series of
  // 2 artanh(s), where |s| < 0.172 makes the terms beyond s^23 vanish.
  constexpr double kLog2 = 0x1.62e42fefa39efp-1;
  constexpr double kSqrt2 = 0x1.6a09e667f3bcdp+0;
  constexpr int kMantissaBits = 52;
  constexpr std::uint64_t kMantissaMask = (std::uint64_t{1} << kMantissaBits) - 1;
  constexpr std::uint64_t kExponentOfOne = 1023;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  int exponent = static_cast<int>(bits >> kMantissaBits) - static_cast<int>(kExponentOfOne);
  auto mantissa = std::bit_cast<double>((bits & kMantissaMask) | (kExponentOfOne << kMantissaBits));
  if (mantissa > kSqrt2) {
    mantissa *= 0.5;
    ++exponent;
  }
  const double s = (mantissa - 1) / (mantissa + 1);
  double sum = 0;
  for (int k = 23; k >= 1; k -= 2) sum = sum * (s * s) + 1.0 / k;
  return exponent * kLog2 + 2 * s * sum;
}

Random::InDisc Random::in_disc() {
  while (true) {
    const double u = 2 * uniform() - 1;
    const double v = 2 * uniform() - 1;
    const double squared_norm = u * u + v * v;
    if (squared_norm < 1 && squared_norm > 0) return {u, v, squared_norm};
  }
}

std::array<double, 2> Random::normal_pair() {
  const InDisc p = in_disc();
  const double factor = std::sqrt(-2 * portable_log(p.squared_norm) / p.squared_norm);
  return {p.u * factor, p.v * factor};
}

}  // namespace spillway::generators

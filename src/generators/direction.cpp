#include "src/generators/direction.h"

#include <cstdint>

namespace spillway::generators {

Direction direction_at(double turns) {
  // The series of sine and cosine, for at most an eighth of a turn either way.
  constexpr double kTwoPi = 0x1.921fb54442d18p+2;
  const double shifted = 4 * turns + 0.5;
  auto quarter = static_cast<std::int64_t>(shifted);
  if (static_cast<double>(quarter) > shifted) --quarter;
  const double angle = (turns - 0.25 * static_cast<double>(quarter)) * kTwoPi;
  const double square = angle * angle;
  double sine = 1;
  double cosine = 1;
  for (int k = 16; k >= 2; k -= 2) {
    sine = 1 - square * (1.0 / (k * (k + 1))) * sine;
    cosine = 1 - square * (1.0 / (k * (k - 1))) * cosine;
  }
  sine *= angle;
  switch (quarter & 3) {
    case 0:
      return {cosine, sine};
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    default:
      return {sine, -cosine};
  }
}

}  // namespace spillway::generators

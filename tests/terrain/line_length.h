#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::test {

inline double length_of(const std::vector<Point<2>>& line) {
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    length += std::hypot(line[i][0] - line[i - 1][0], line[i][1] - line[i - 1][1]);
  }
  return length;
}

}  // namespace spillway::test

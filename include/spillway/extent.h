#pragma once

#include <array>

namespace spillway {

/// A box whose sides are parallel to the axes x, y, z.
struct Extent {
  std::array<double, 3> low{};
  std::array<double, 3> high{};

  bool operator==(const Extent&) const = default;
};

}  // namespace spillway

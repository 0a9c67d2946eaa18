#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "src/rooms.h"

namespace spillway::picture {

/// Red, green and blue from 0 to 1, in sRGB.
using Colour = std::array<float, 3>;

inline constexpr Colour kBlack = {0, 0, 0};
inline constexpr Colour kWhite = {1, 1, 1};

/// The colour at a share of the way from `a` to `b`.
inline Colour mix(const Colour& a, const Colour& b, float share) {
  Colour mixed{};
  for (std::size_t k = 0; k < 3; ++k) mixed[k] = a[k] + (b[k] - a[k]) * share;
  return mixed;
}

/// A colour between those of an evenly spaced table, for `t` from 0 to 1; the nearest end beyond.
inline Colour colour_at(std::span<const Colour> table, double t) {
  const double place = std::clamp(t, 0.0, 1.0) * static_cast<double>(table.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(place), table.size() - 2);
  return mix(table[before], table[before + 1],
             static_cast<float>(place - static_cast<double>(before)));
}

}  // namespace spillway::picture

#pragma once

#include <cstdint>

namespace spillway::formats {

/// The copy of a vertex that a corner of a periodic mesh is: 0, 1 or -1 periods along each of up to
/// three axes, in two bits an axis, x in the lowest ones.
enum class CornerOffset : std::uint8_t {};

inline constexpr CornerOffset kNoOffset{0};

/// Bits that no offset has set.
inline constexpr std::uint8_t kNoOffsetBits = 0xC0;

/// -1, 0 or 1. The number -2 stands for none.
inline int periods_along(CornerOffset offset, int axis) {
  const int bits = static_cast<std::uint8_t>(offset) >> (2 * axis) & 3;
  return bits >= 2 ? bits - 4 : bits;
}

/// `periods` has a number for each of some axes.
template <typename Periods>
CornerOffset corner_offset(const Periods& periods) {
  unsigned bits = 0;
  int axis = 0;
  for (const auto number : periods) bits |= (static_cast<unsigned>(number) & 3U) << (2 * axis++);
  return static_cast<CornerOffset>(bits);
}

}  // namespace spillway::formats

#pragma once
// Where the fields of a LAS record lie, and differences of their values.

#include <cstddef>
#include <cstdint>

#include "formats/bytes/bytes.h"

namespace spillway::formats::laz {

inline constexpr std::size_t kX = 0;
inline constexpr std::size_t kY = 4;
inline constexpr std::size_t kZ = 8;
inline constexpr std::size_t kIntensity = 12;
inline constexpr std::size_t kReturns = 14;

namespace core10 {
inline constexpr std::size_t kSize = 20;
inline constexpr std::size_t kClass = 15;
inline constexpr std::size_t kAngle = 16;
inline constexpr std::size_t kUser = 17;
inline constexpr std::size_t kSource = 18;
}  // namespace core10

namespace core14 {
inline constexpr std::size_t kSize = 30;
inline constexpr std::size_t kFlags = 15;
inline constexpr std::size_t kClass = 16;
inline constexpr std::size_t kUser = 17;
inline constexpr std::size_t kAngle = 18;
inline constexpr std::size_t kSource = 20;
inline constexpr std::size_t kGpsTime = 22;
}  // namespace core14

namespace wave_packet {
inline constexpr std::size_t kIndex = 0;
inline constexpr std::size_t kOffset = 1;
inline constexpr std::size_t kSize = 9;
inline constexpr std::size_t kReturnPoint = 13;
inline constexpr std::size_t kDirection = 17;
}  // namespace wave_packet

/// The byte at a place in a record.
inline unsigned byte_at(const std::byte* record, std::size_t at) {
  return std::to_integer<unsigned>(record[at]);
}

/// A value modulo 2^32, for sums and differences that wrap around.
inline std::uint32_t word_at(const std::byte* record, std::size_t at) {
  return load<std::uint32_t>(record + at);
}

inline std::uint16_t short_at(const std::byte* record, std::size_t at) {
  return load<std::uint16_t>(record + at);
}

/// Puts the lowest byte of a value at a place in a record.
inline void put_byte(std::byte* record, std::size_t at, unsigned value) {
  record[at] = static_cast<std::byte>(value);
}

/// A 64-bit pattern plus a difference of 32 bits, one of which is its sign.
inline std::uint64_t sum64(std::uint64_t value, std::uint32_t difference) {
  return value + static_cast<std::uint64_t>(std::int64_t{static_cast<std::int32_t>(difference)});
}

/// a - b as 64-bit patterns.
inline std::int64_t difference64(std::uint64_t a, std::uint64_t b) {
  return static_cast<std::int64_t>(a - b);
}

inline bool fits_32_bits(std::int64_t value) { return value == static_cast<std::int32_t>(value); }

}  // namespace spillway::formats::laz

#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace spillway::detail::testing {

/// The little-endian value at a place in a record.
template <typename T>
T field(std::string_view record, std::size_t at) {
  T value;
  std::memcpy(&value, record.substr(at, sizeof(T)).data(), sizeof(T));
  return value;
}

inline std::uint8_t byte_at(std::string_view record, std::size_t at) {
  return static_cast<std::uint8_t>(record.at(at));
}

/// The values modulo 2^32, without overflow.
inline std::int32_t difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}
inline std::int32_t product(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b));
}

/// a - b as 64-bit patterns, modulo 2^64.
inline std::int64_t difference64(std::uint64_t a, std::uint64_t b) {
  return static_cast<std::int64_t>(a - b);
}

inline bool fits_32_bits(std::int64_t value) { return value == static_cast<std::int32_t>(value); }

/// Where x, y and z lie in every record, and the fields of the two kinds of records.
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

inline unsigned channel(std::string_view record) { return byte_at(record, kFlags) >> 4 & 3; }
}  // namespace core14

}  // namespace spillway::detail::testing

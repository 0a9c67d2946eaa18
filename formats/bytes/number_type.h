#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace spillway::detail {

/// The types of numbers in binary mesh files.
enum class NumberType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
};

/// Bytes of one number.
std::size_t size_of(NumberType type);

[[nodiscard]] constexpr bool is_integer(NumberType type) {
  return type != NumberType::kFloat32 && type != NumberType::kFloat64;
}

/// The number at `bytes`, its byte order reversed if `swap`; a 64-bit integer is rounded to the
/// nearest double.
double load_number(NumberType type, const std::byte* bytes, bool swap);

/// The number at `bytes` as an index; nothing if it is negative or as to_index() says.
std::optional<std::uint64_t> load_index(NumberType type, const std::byte* bytes, bool swap);

/// A double as an index; nothing if it is negative, not whole, or beyond 2^53, where not every
/// integer is a double.
std::optional<std::uint64_t> to_index(double value);

}  // namespace spillway::detail

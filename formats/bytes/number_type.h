#pragma once
// Numbers of a type that is known when the program runs.

#include <spillway/attribute.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "formats/bytes/bytes.h"

namespace spillway::formats {

/// Calls f with a number of that type, 0, and returns what it returns.
template <typename F>
constexpr decltype(auto) with_number_type(NumberType type, F&& f) {
  switch (type) {
    case NumberType::kInt8:
      return f(std::int8_t{});
    case NumberType::kUint8:
      return f(std::uint8_t{});
    case NumberType::kInt16:
      return f(std::int16_t{});
    case NumberType::kUint16:
      return f(std::uint16_t{});
    case NumberType::kInt32:
      return f(std::int32_t{});
    case NumberType::kUint32:
      return f(std::uint32_t{});
    case NumberType::kInt64:
      return f(std::int64_t{});
    case NumberType::kUint64:
      return f(std::uint64_t{});
    case NumberType::kFloat32:
      return f(float{});
    case NumberType::kFloat64:
      break;
  }
  return f(double{});
}

/// Bytes of one number.
constexpr std::size_t size_of(NumberType type) {
  return with_number_type(type, [](auto number) { return sizeof(number); });
}

[[nodiscard]] constexpr bool is_integer(NumberType type) {
  return type != NumberType::kFloat32 && type != NumberType::kFloat64;
}

[[nodiscard]] constexpr bool is_signed_integer(NumberType type) {
  return with_number_type(type, [](auto number) {
    return std::is_integral_v<decltype(number)> && std::is_signed_v<decltype(number)>;
  });
}

/// "int8", "uint16", "float64", ...
std::string_view name_of(NumberType type);

/// The number at `bytes`; a 64-bit integer is rounded to the nearest double.
inline double load_number(NumberType type, const std::byte* bytes) {
  return with_number_type(
      type, [bytes](auto number) { return static_cast<double>(load<decltype(number)>(bytes)); });
}

/// The same with its byte order reversed if `swap`.
double load_number(NumberType type, const std::byte* bytes, bool swap);

/// Puts `value` at `bytes`; float32 is rounded. Returns false, and puts nothing, where an integer
/// cannot be that value: it is not whole, or out of range.
bool store_number(NumberType type, std::byte* bytes, double value);

/// The number at `bytes` as an index; nothing if it is negative or as to_index() says.
std::optional<std::uint64_t> load_index(NumberType type, const std::byte* bytes, bool swap);

/// A double as an index; nothing if it is negative, not whole, or beyond 2^53, where not every
/// integer is a double.
std::optional<std::uint64_t> to_index(double value);

}  // namespace spillway::formats

#include "formats/bytes/number_type.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstring>

namespace spillway::detail {
namespace {

template <typename T>
T load_value(const std::byte* bytes, bool swap) {
  std::array<std::byte, sizeof(T)> own;
  std::memcpy(own.data(), bytes, sizeof(T));
  if (swap) std::reverse(own.begin(), own.end());
  T value;
  std::memcpy(&value, own.data(), sizeof(T));
  return value;
}

/// Calls f with the number in its own type.
template <typename F>
auto visit(NumberType type, const std::byte* bytes, bool swap, const F& f) {
  switch (type) {
    case NumberType::kInt8:
      return f(load_value<std::int8_t>(bytes, swap));
    case NumberType::kUint8:
      return f(load_value<std::uint8_t>(bytes, swap));
    case NumberType::kInt16:
      return f(load_value<std::int16_t>(bytes, swap));
    case NumberType::kUint16:
      return f(load_value<std::uint16_t>(bytes, swap));
    case NumberType::kInt32:
      return f(load_value<std::int32_t>(bytes, swap));
    case NumberType::kUint32:
      return f(load_value<std::uint32_t>(bytes, swap));
    case NumberType::kInt64:
      return f(load_value<std::int64_t>(bytes, swap));
    case NumberType::kUint64:
      return f(load_value<std::uint64_t>(bytes, swap));
    case NumberType::kFloat32:
      return f(load_value<float>(bytes, swap));
    case NumberType::kFloat64:
      break;
  }
  return f(load_value<double>(bytes, swap));
}

}  // namespace

std::size_t size_of(NumberType type) {
  switch (type) {
    case NumberType::kInt8:
    case NumberType::kUint8:
      return 1;
    case NumberType::kInt16:
    case NumberType::kUint16:
      return 2;
    case NumberType::kInt32:
    case NumberType::kUint32:
    case NumberType::kFloat32:
      return 4;
    default:
      return 8;
  }
}

double load_number(NumberType type, const std::byte* bytes, bool swap) {
  return visit(type, bytes, swap, [](auto value) { return static_cast<double>(value); });
}

std::optional<std::uint64_t> load_index(NumberType type, const std::byte* bytes, bool swap) {
  return visit(type, bytes, swap, [](auto value) -> std::optional<std::uint64_t> {
    if constexpr (std::floating_point<decltype(value)>) {
      return to_index(value);
    } else {
      if (value < 0) return std::nullopt;
      return static_cast<std::uint64_t>(value);
    }
  });
}

std::optional<std::uint64_t> to_index(double value) {
  if (!(value >= 0 && value <= 0x1p53) || value != std::floor(value)) return std::nullopt;
  return static_cast<std::uint64_t>(value);
}

}  // namespace spillway::detail

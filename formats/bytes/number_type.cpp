#include "formats/bytes/number_type.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstring>
#include <limits>

namespace spillway::formats {
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
  return with_number_type(
      type, [&](auto number) { return f(load_value<decltype(number)>(bytes, swap)); });
}

}  // namespace

std::string_view name_of(NumberType type) {
  constexpr std::array<std::string_view, 10> kNames = {"int8",    "uint8",  "int16", "uint16",
                                                       "int32",   "uint32", "int64", "uint64",
                                                       "float32", "float64"};
  return kNames.at(static_cast<std::size_t>(type));
}

double load_number(NumberType type, const std::byte* bytes, bool swap) {
  return visit(type, bytes, swap, [](auto value) { return static_cast<double>(value); });
}

bool store_number(NumberType type, std::byte* bytes, double value) {
  return with_number_type(type, [&](auto number) {
    using Number = decltype(number);
    if constexpr (std::integral<Number>) {
      // The first number above all is a power of two, and so exact.
      const double above = std::ldexp(1.0, std::numeric_limits<Number>::digits);
      const auto least = static_cast<double>(std::numeric_limits<Number>::min());
      if (!(value >= least && value < above) || value != std::floor(value)) return false;
    }
    store(bytes, static_cast<Number>(value));
    return true;
  });
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

}  // namespace spillway::formats

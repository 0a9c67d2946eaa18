#pragma once
// Little-endian values in byte buffers. All binary point formats are little-endian, as are the
// machines that Spillway runs on.

#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

static_assert(std::endian::native == std::endian::little, "the formats are read and written as is");

/// The value at `bytes`, which need not be aligned.
template <typename T>
T load(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// Puts `value` at `bytes`, which need not be aligned.
template <typename T>
void store(std::byte* bytes, const T& value) {
  std::memcpy(bytes, &value, sizeof(T));
}

/// The bytes as characters.
inline std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The characters as bytes.
inline std::span<const std::byte> as_bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace spillway::formats

#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/points/laz/coding/record_fields.h"

namespace spillway::formats::laz {

/// What items keep of the values that they decode.
enum class Keep {
  kNeeded,  ///< only what later symbols depend on
  kWhole,   ///< all bytes of the record
};

/// A part of the last record, which becomes that of the next one. Where only what is needed is
/// kept, it has no bytes: all are 0, and none is stored, so that compilers leave out whatever is
/// computed for them.
template <Keep kKeep>
class KeptPart {
 public:
  explicit KeptPart(std::byte* bytes) : bytes_(bytes) {}

  template <typename T>
  [[nodiscard]] T get(std::size_t at) const {
    if constexpr (kKeep == Keep::kWhole) return load<T>(bytes_ + at);
    return {};
  }
  [[nodiscard]] unsigned byte_at(std::size_t at) const { return get<std::uint8_t>(at); }
  [[nodiscard]] unsigned short_at(std::size_t at) const { return get<std::uint16_t>(at); }
  [[nodiscard]] std::uint32_t word_at(std::size_t at) const { return get<std::uint32_t>(at); }

  template <typename T>
  void put(std::size_t at, T value) const {
    if constexpr (kKeep == Keep::kWhole) store(bytes_ + at, value);
  }
  /// Keeps the lowest byte.
  void put_byte(std::size_t at, unsigned value) const { put(at, static_cast<std::uint8_t>(value)); }
  /// Keeps the lowest 16 bits.
  void put_short(std::size_t at, std::uint32_t value) const {
    put(at, static_cast<std::uint16_t>(value));
  }

 private:
  std::byte* bytes_;
};

}  // namespace spillway::formats::laz

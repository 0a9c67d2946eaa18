#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "formats/points/laz/coding/record_fields.h"

namespace spillway::test {

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

using laz::kIntensity;
using laz::kReturns;
using laz::kX;
using laz::kY;
using laz::kZ;
namespace core10 = laz::core10;
namespace core14 = laz::core14;

}  // namespace spillway::test

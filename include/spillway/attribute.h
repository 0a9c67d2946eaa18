#pragma once

#include <spillway/export.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace spillway {

/// What a number is in memory.
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
  kFloat64
};

/// The type's name in words: "int8", "uint16", "float64".
SPILLWAY_API const char* to_string(NumberType type) noexcept;

/// Something that points carry besides their coordinates: "intensity", "gps_time".
struct Attribute {
  std::string name;  ///< of LAS those of docs/attributes.md, of others as the source has it
  NumberType type = NumberType::kFloat64;
  std::size_t elements = 1;  ///< numbers of a point; 1 but for arrays
  /// What is meant is number * scale + offset.
  double scale = 1;
  double offset = 0;
  std::string unit{};         ///< where the source tells it
  std::string description{};  ///< likewise

  bool operator==(const Attribute&) const = default;
};

}  // namespace spillway

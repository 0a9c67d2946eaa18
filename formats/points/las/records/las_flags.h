#pragma once

#include <cstdint>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"

namespace spillway::formats {

/// What LAS says of a point besides its coordinates that takes few layers of LAZ to know.
struct LasFlags {
  std::uint8_t classification = 0;
  std::uint8_t return_number = 0;  ///< counted from 1; 0: not known
  std::uint8_t return_count = 0;   ///< of its pulse; 0: not known
  std::uint8_t flags = 0;          ///< the k... flags below

  static constexpr std::uint8_t kSynthetic = 1;
  static constexpr std::uint8_t kKeyPoint = 2;
  static constexpr std::uint8_t kWithheld = 4;
  static constexpr std::uint8_t kOverlap = 8;

  bool operator==(const LasFlags&) const = default;
};

/// Its members as fields of a record.
std::vector<AttributeField> las_flag_fields();

}  // namespace spillway::formats

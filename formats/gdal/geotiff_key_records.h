#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "src/rooms.h"

namespace spillway::formats {

/// GeoTIFF keys as files have them, a record for each of the three tags. Source: OGC, "GeoTIFF
/// Standard" 1.1 (19-008r4), 7.1.
struct GeotiffKeys {
  std::vector<std::byte> directory{};  ///< 34735: four numbers of 16 bits for each key
  std::vector<std::byte> numbers{};    ///< 34736: doubles that keys refer to
  std::string text{};                  ///< 34737: texts that keys refer to

  [[nodiscard]] bool empty() const { return directory.empty(); }
  bool operator==(const GeotiffKeys&) const = default;
};

}  // namespace spillway::formats

#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "formats/points/las/records/las_flags.h"

namespace spillway::test {

/// Whatever the fields of LAS 1.4, or of 1.2, can hold.
inline std::vector<LasFlags> random_attributes(std::size_t count, bool version14, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<LasFlags> attributes(count);
  const std::uint32_t returns = version14 ? 16 : 8;
  for (LasFlags& a : attributes) {
    a.classification = static_cast<std::uint8_t>(random() % (version14 ? 256 : 32));
    a.return_number = static_cast<std::uint8_t>(random() % returns);
    a.return_count = static_cast<std::uint8_t>(random() % returns);
    a.flags = static_cast<std::uint8_t>(random() % returns);
  }
  return attributes;
}

}  // namespace spillway::test

#pragma once
// LAS files of known classes and returns, for tests of the command.

#include <cstdint>
#include <string>
#include <vector>

#include "tests/formats/points/las/las_file.h"

namespace spillway::test {

/// A LAS file of `count` points, no two of equal x, y, on a lattice of 0.01, that belongs to a
/// sequence of such files: record i has class (first + i) % 5 and is return 1 + i % 3 of 3.
inline LasFile scattered_las(int first, int count) {
  LasFile las;
  las.records.clear();
  for (int i = 0; i < count; ++i) {
    const std::uint32_t n = static_cast<std::uint32_t>(first + i);
    LasFlags attributes;
    attributes.classification = static_cast<std::uint8_t>(n % 5);
    attributes.return_number = static_cast<std::uint8_t>(1 + i % 3);
    attributes.return_count = 3;
    las.records.push_back({static_cast<std::int32_t>(n * 2654435761U % 100003),
                           static_cast<std::int32_t>(n * 40503U % 100019),
                           static_cast<std::int32_t>(n % 977), false, attributes});
  }
  return las;
}

/// The GeoTIFF keys of a projected coordinate system.
inline LasFile::Vlr epsg_keys(std::uint16_t code) {
  std::string keys;
  for (const std::uint16_t value : std::vector<std::uint16_t>{1, 1, 0, 1, 3072, 0, 1, code}) {
    keys += bytes_of(value);
  }
  return {"LASF_Projection", 34735, keys};
}

}  // namespace spillway::test

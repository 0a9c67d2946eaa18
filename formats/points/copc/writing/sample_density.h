#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/points/copc/writing/octree_cube.h"

namespace spillway::formats {

/// Chooses how many sample cells nodes have, by a few of the points: points of a surface meet few
/// cells of a cube, those of a volume nearly all.
class SampleDensity {
 public:
  void add(std::span<const std::byte> records, std::size_t record_length);

  /// OctreeRules::sample_bits: 7, or less where the sample of the root would have more points than
  /// that.
  [[nodiscard]] unsigned sample_bits(const OctreeCube& cube, std::uint64_t most_points) const;

 private:
  std::uint64_t seen_ = 0;
  std::uint64_t stride_ = 1;                       // every so many-th point is kept
  std::vector<std::array<std::int32_t, 3>> kept_;  // integers
};

}  // namespace spillway::formats

#pragma once

#include <cstdint>

namespace spillway {

/// What is known of a mesh after its last block.
struct MeshTotals {
  std::uint64_t vertices = 0;
  std::uint64_t simplices = 0;
  std::uint64_t hull_facets = 0;  ///< facets of one simplex only
  std::uint64_t points = 0;       ///< of the input
  std::uint64_t duplicates = 0;   ///< points that equal another one (in the plane: in x and y)
  /// A number that depends on nothing but the set of simplices, each the set of its vertices'
  /// coordinates; the command prints it as 16 hexadecimal digits.
  std::uint64_t canonical_hash = 0;

  bool operator==(const MeshTotals&) const = default;
};

}  // namespace spillway

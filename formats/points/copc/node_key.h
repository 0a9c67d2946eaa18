#pragma once
// A node of the octree, and what the hierarchy of a COPC file says of it. Source: COPC 1.0,
// https://copc.io ("hierarchy VLR").

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>

#include "formats/bytes/bytes.h"

namespace spillway::formats {

/// A node's place in the octree.
struct NodeKey {
  std::int32_t level = 0;
  std::array<std::int32_t, 3> cell{};  ///< x, y, z among the 2^level along each axis

  // NOLINTNEXTLINE(modernize-use-nullptr): a false finding in what the compiler generates
  auto operator<=>(const NodeKey&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// An entry of a page of the hierarchy.
struct HierarchyEntry {
  NodeKey key;
  std::uint64_t offset = 0;  ///< of the chunk or page
  std::int32_t bytes = 0;    ///< of the chunk or page
  std::int32_t count = 0;    ///< of points, or kInOtherPage

  static constexpr std::size_t kSize = 32;          ///< bytes in the file
  static constexpr std::int32_t kInOtherPage = -1;  ///< `offset` leads to a page that tells more
};

inline HierarchyEntry load_entry(const std::byte* bytes) {
  return {{load<std::int32_t>(bytes), load<std::array<std::int32_t, 3>>(bytes + 4)},
          load<std::uint64_t>(bytes + 16),
          load<std::int32_t>(bytes + 24),
          load<std::int32_t>(bytes + 28)};
}

inline void store_entry(std::byte* bytes, const HierarchyEntry& entry) {
  store(bytes, entry.key.level);
  store(bytes + 4, entry.key.cell);
  store(bytes + 16, entry.offset);
  store(bytes + 24, entry.bytes);
  store(bytes + 28, entry.count);
}

}  // namespace spillway::formats

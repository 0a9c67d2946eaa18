#pragma once

#include <compare>
#include <cstdint>
#include <limits>

#include "src/rooms.h"

namespace spillway::stream {

/// The place of a block in the stream: tiles and merges of tiles have a slot each, in the order in
/// which they come, and one or many blocks in it.
struct BlockPlace {
  static constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t slot = kNowhere;
  std::uint32_t block = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): a false finding in what the compiler generates
  auto operator<=>(const BlockPlace&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Where a vertex was announced in the stream: in which block, and as which of its vertices.
struct StreamPlace {
  BlockPlace block;
  std::uint32_t vertex = 0;

  [[nodiscard]] bool announced() const { return block.slot != BlockPlace::kNowhere; }
};

}  // namespace spillway::stream

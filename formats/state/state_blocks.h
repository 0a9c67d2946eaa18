#pragma once

#include <cstddef>
#include <cstdint>

#include "src/rooms.h"

namespace spillway::formats {

/// The blocks of a state: some bytes of it, and the last ones.
inline constexpr std::uint32_t kStateBlock = 0x53545401;
inline constexpr std::uint32_t kLastStateBlock = 0x53545402;

/// Bytes of a block but the last.
inline constexpr std::size_t kStateBlockBytes = std::size_t{1} << 20;

}  // namespace spillway::formats

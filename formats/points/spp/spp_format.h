#pragma once
// What reader and writer of Spillway's own point stream share. docs/formats-blocks.md has the
// layout.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "formats/points/common/point_format.h"

namespace spillway::detail {

extern const PointFormat kSppPoints;

inline constexpr std::string_view kSppMagic = "SPWYSPP\n";
inline constexpr std::uint32_t kSppVersion = 1;

/// Kinds of blocks.
inline constexpr std::uint32_t kSppHeader = 1;
inline constexpr std::uint32_t kSppPointBlock = 2;
inline constexpr std::uint32_t kSppTrailer = 3;

/// Bits of the header's flags, for what follows them.
inline constexpr std::uint32_t kSppHasLattice = 1;
inline constexpr std::uint32_t kSppHasCount = 2;
inline constexpr std::uint32_t kSppHasExtent = 4;

/// The most points in a block, and bytes in one of any kind; what claims more is corrupt.
inline constexpr std::size_t kSppBlockPoints = 65536;
inline constexpr std::size_t kSppLargestBlock = std::size_t{2} << 20;

}  // namespace spillway::detail

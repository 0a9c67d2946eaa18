#pragma once
// What reader and writer of Spillway's own point stream share. docs/formats-blocks.md has the
// layout.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "formats/points/common/point_format.h"

namespace spillway::formats {

extern const PointFormat kSppPoints;

inline constexpr std::string_view kSppMagic = "SPWYSPP\n";
inline constexpr std::uint32_t kSppVersion = 1;        ///< points in any order
inline constexpr std::uint32_t kSppSortedVersion = 2;  ///< points cell by cell

/// Kinds of blocks.
inline constexpr std::uint32_t kSppHeader = 1;
inline constexpr std::uint32_t kSppPointBlock = 2;
inline constexpr std::uint32_t kSppTrailer = 3;
inline constexpr std::uint32_t kSppCellTable = 4;
inline constexpr std::uint32_t kSppCellPoints = 5;
inline constexpr std::uint32_t kSppLastOfCell = 6;  ///< no more points in this cell

/// Bits of the header's flags, for what follows them. A sorted stream has the first only.
inline constexpr std::uint32_t kSppHasLattice = 1;
inline constexpr std::uint32_t kSppHasCount = 2;
inline constexpr std::uint32_t kSppHasExtent = 4;
inline constexpr std::uint32_t kSppHasAttributes = 8;

/// The most points in a block, and bytes in one of any kind; what claims more is corrupt.
inline constexpr std::size_t kSppBlockPoints = 65536;
inline constexpr std::size_t kSppLargestBlock = std::size_t{2} << 20;
/// Likewise the most cells in a block of their table, and in a stream.
inline constexpr std::size_t kSppTableCells = 16384;
inline constexpr std::size_t kSppMostCells = std::size_t{1} << 20;

}  // namespace spillway::formats

#pragma once
// What reader and writer of Spillway's own point stream share. docs/formats-blocks.md has the
// layout.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace spillway::detail {

inline constexpr std::string_view kSppMagic = "SPWYSPP\n";
inline constexpr std::uint32_t kSppVersion = 1;

/// Kinds of blocks.
inline constexpr std::uint32_t kSppHeader = 1;
inline constexpr std::uint32_t kSppPoints = 2;
inline constexpr std::uint32_t kSppTrailer = 3;

/// Bits of the header's flags, for what follows them.
inline constexpr std::uint32_t kSppHasLattice = 1;
inline constexpr std::uint32_t kSppHasCount = 2;
inline constexpr std::uint32_t kSppHasExtent = 4;

/// The most points in a block, and bytes in one of any kind; what claims more is corrupt.
inline constexpr std::size_t kSppBlockPoints = 65536;
inline constexpr std::size_t kSppLargestBlock = std::size_t{2} << 20;

/// The first of `values` that is no coordinate (not finite or, if they are to be on a lattice, no
/// integer from -2^53 to 2^53); their number if all are.
std::size_t first_invalid_coordinate(std::span<const double> values, bool on_lattice);

}  // namespace spillway::detail

#pragma once

#include <cstddef>

#include "src/rooms.h"

namespace spillway::ranks {

/// A border of fewer points is triangulated by one rank, which takes about as long there as by half
/// of the ranks, and fewer messages (docs/performance.md, "Over ranks").
template <int D>
inline constexpr std::size_t kGatherBelow = D == 2 ? 20'000 : 10'000;

}  // namespace spillway::ranks

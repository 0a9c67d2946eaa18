#pragma once

#include "src/rooms.h"

namespace spillway::delaunay {

/// How many doubles the processor can compute with at a time, as far as it matters to the own
/// kernels: 2, 4 (AVX2) or 8 (AVX-512, of which they use only that there are twice as many
/// registers for 4 lanes).
int widest_lanes();

/// That, or the limit that was set.
int lane_width();

/// Limits that, for measurements and tests; the result is the same. To be called before work
/// starts.
void limit_lanes(int doubles);

}  // namespace spillway::delaunay

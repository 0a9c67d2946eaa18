#pragma once

#include <functional>

#include "src/distributed/ranks.h"

namespace spillway::ranks {

/// Runs a step at all ranks, in which they do not wait for each other. If it fails at some, the
/// first of them throws what it met, and all others wait to be ended. Collective.
void run_collective_step(const distributed::Ranks& ranks, const std::function<void()>& step);

}  // namespace spillway::ranks

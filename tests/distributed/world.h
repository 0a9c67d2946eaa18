#pragma once
// The ranks that a test program under mpirun was started with.

#include "src/distributed/ranks.h"

namespace spillway::test {

/// All ranks of the job; the main function of the test program has joined them.
const Ranks& world();

}  // namespace spillway::test

#pragma once

#include <vector>

#include "tests/benchmark/rank_runs.h"

namespace spillway::test {

/// What cannot be measured on one machine.
struct Network {
  double bytes_per_second = 1e9;  ///< of a rank
  double latency = 5e-6;          ///< seconds a message
};

/// Prints the statistics that the model takes from `runs`, the first of one rank and the last of most
/// ranks, and what it makes of them for up to 2,048 ranks: docs/performance.md derives it.
void print_model(const Plan& plan, const std::vector<RankRun>& runs, const Network& network);

}  // namespace spillway::test

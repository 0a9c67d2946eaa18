#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/simulate/core_simulation.h"

namespace spillway::command {

/// Reads a list of core counts: "1,2,8", and "1,2,4,...,1024", where the dots stand for doubling.
/// Throws UsageError.
std::vector<unsigned> parse_core_list(std::string_view text);

/// A table for people: a heading, then one line a run; no line end after the last.
std::string simulation_table(const std::vector<SimulatedRun>& runs);

}  // namespace spillway::command

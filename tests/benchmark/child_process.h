#pragma once

#include <string>
#include <vector>

namespace spillway::test {

/// What a program and all programs that it has started and waited for took.
struct ProcessFigures {
  double seconds = 0;
  double cpu_seconds = 0;  ///< user and system, of all of them
  double peak_mib = 0;     ///< of the largest
};

/// Runs a program (its path, its arguments) to its end; ends this one if that fails.
ProcessFigures run_program(const std::vector<std::string>& words);

}  // namespace spillway::test

#pragma once
// What `--progress json` writes, and the laws that it keeps.

#include <cstdint>
#include <string>
#include <vector>

namespace spillway::test {

/// A phase as its last line has it.
struct EndedPhase {
  std::string name;
  std::uint64_t done = 0;
  std::string unit;
  std::size_t lines = 0;  ///< that were written of it, the last one counted

  bool operator==(const EndedPhase& other) const {
    return name == other.name && done == other.done && unit == other.unit;
  }
};

/// For messages of gtest.
std::ostream& operator<<(std::ostream& stream, const EndedPhase& phase);

/// The phases of a run's standard error, in the order in which they ended; one may lie within
/// another. Fails the test unless each line is one object, `done` and `fraction` only grow within a
/// phase, fractions lie between 0 and 1, and each phase has one last line, with the fraction 1.
std::vector<EndedPhase> ended_phases(const std::string& standard_error);

}  // namespace spillway::test

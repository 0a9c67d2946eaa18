// What the process lets go of before it works.

#include "tools/process/program_pages.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace spillway::test {
namespace {

/// Pages of files that the process has in memory, in KiB; 0 where the system does not tell.
int file_pages() {
  std::ifstream status("/proc/self/status");
  const std::string label = "RssFile:";
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(label)) return std::stoi(line.substr(label.size()));
  }
  return 0;
}

TEST(ProgramPages, AreLetGoOfAndComeBackWhenTheyAreNeeded) {
  const int before = file_pages();
  if (before == 0) GTEST_SKIP() << "the system does not tell of its pages";
  let_go_of_program_pages();
  EXPECT_LT(file_pages(), before);
  EXPECT_EQ(std::to_string(1.5).substr(0, 3), "1.5") << "the libraries work as before";
}

}  // namespace
}  // namespace spillway::test

// The command with one more line in its table of subcommands.

#include <vector>

#include "tools/program.h"

namespace spillway::test {
Subcommand add_mean_slope(CommandLine& root);
}

int main(int argc, char** argv) {
  using namespace spillway::test;  // NOLINT(google-build-using-namespace)
  const auto all = subcommands();
  std::vector<AddSubcommand> table(all.begin(), all.end());
  table.push_back({"mean-slope", add_mean_slope});
  return run_program(argc, argv, table);
}

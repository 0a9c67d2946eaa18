#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/options/command_line.h"
#include "tools/process/exit_code.h"

namespace spillway::detail {

/// A subcommand in the tree of options, and what to do once the command line is parsed.
struct Subcommand {
  CommandLine* app;
  std::function<int()> run;  ///< returns the exit code
  bool over_ranks = false;   ///< works together with the other processes of mpirun
};

/// One for each subcommand: adds it to the tree. Each is defined in the file of its name.
Subcommand add_triangulate(CommandLine& root);
Subcommand add_dem(CommandLine& root);
Subcommand add_contour(CommandLine& root);
Subcommand add_render(CommandLine& root);
Subcommand add_info(CommandLine& root);
Subcommand add_convert(CommandLine& root);
Subcommand add_generate(CommandLine& root);
Subcommand add_check(CommandLine& root);
/// After those that make outputs: it takes over their options.
Subcommand add_batch(CommandLine& root);
Subcommand add_completion(CommandLine& root);
Subcommand add_manual(CommandLine& root);

/// Throws UsageError if run_command() would do so before it does anything: a subcommand's arguments
/// that come from a list of jobs are checked before the work on any of them begins.
void check_command_line(const std::vector<std::string>& arguments);

/// Parses the command line and does what it says. Returns the exit code; throws UsageError for a
/// wrong command line and Error for what goes wrong later.
int run_command(int argc, const char* const* argv);

}  // namespace spillway::detail

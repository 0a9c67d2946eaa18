#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/options/command_line.h"
#include "tools/process/exit_code.h"

namespace spillway::command {

/// A subcommand in the tree of options, and what to do once the command line is parsed.
struct Subcommand {
  CommandLine* app;
  std::function<int()> run;  ///< returns the exit code
  bool over_ranks = false;   ///< works together with the other processes of mpirun
};

/// What adds the subcommand of a name to the tree.
struct AddSubcommand {
  std::string_view name;
  Subcommand (*add)(CommandLine& root);
  bool needs_others = false;  ///< looks at the options of other subcommands
};

/// The table of all subcommands, in the order in which help lists them.
std::span<const AddSubcommand> subcommands();

/// Throws UsageError if run_command() would do so before it does anything: a subcommand's arguments
/// that come from a list of jobs are checked before the work on any of them begins.
void check_command_line(const std::vector<std::string>& arguments);

/// Parses the command line and does what it says. Returns the exit code; throws UsageError for a
/// wrong command line and Failure for what goes wrong later.
int run_command(int argc, const char* const* argv,
                std::span<const AddSubcommand> table = subcommands());

}  // namespace spillway::command

#pragma once

#include <span>

#include "tools/commands/command.h"

namespace spillway::command {

/// All that a program with these subcommands does: signals, the command line, what it says, and the
/// report of what went wrong. Returns the exit code. To be called first in main().
int run_program(int argc, char** argv, std::span<const AddSubcommand> table);

}  // namespace spillway::command

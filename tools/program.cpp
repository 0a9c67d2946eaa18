#include "tools/program.h"

#include <exception>

#include "tools/process/failure.h"
#include "tools/process/interrupts.h"
#include "tools/process/rank_job.h"
#include "tools/process/standard_descriptors.h"

namespace spillway::command {

int run_program(int argc, char** argv, std::span<const AddSubcommand> table) {
  block_interrupts();
  open_standard_descriptors();
  handle_uncaught_exceptions();
  try {
    handle_interrupts();
    const int exit_code = run_command(argc, argv, table);
    leave_ranks();
    tell_of_temporary_paths_left();
    return exit_code;
  } catch (...) {
    const int exit_code = report_failure(std::current_exception());
    tell_of_temporary_paths_left();
    return exit_code;
  }
}

}  // namespace spillway::command

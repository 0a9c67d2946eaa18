#include <exception>

#include "tools/commands/command.h"
#include "tools/process/failure.h"
#include "tools/process/interrupts.h"
#include "tools/process/rank_job.h"
#include "tools/process/standard_descriptors.h"

int main(int argc, char** argv) {
  spillway::detail::block_interrupts();
  spillway::detail::open_standard_descriptors();
  spillway::detail::handle_uncaught_exceptions();
  try {
    spillway::detail::handle_interrupts();
    const int exit_code = spillway::detail::run_command(argc, argv);
    spillway::detail::leave_ranks();
    return exit_code;
  } catch (...) {
    return spillway::detail::report_failure(std::current_exception());
  }
}

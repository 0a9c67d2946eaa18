#include <exception>

#include "tools/command.h"
#include "tools/failure.h"
#include "tools/interrupts.h"
#include "tools/rank_job.h"
#include "tools/standard_descriptors.h"

int main(int argc, char** argv) {
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

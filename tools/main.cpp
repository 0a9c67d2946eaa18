#include <exception>

#include "tools/command.h"
#include "tools/failure.h"
#include "tools/interrupts.h"
#include "tools/rank_job.h"
#include "tools/standard_descriptors.h"

int main(int argc, char** argv) {
  spillway::open_standard_descriptors();
  spillway::handle_uncaught_exceptions();
  try {
    spillway::handle_interrupts();
    const int exit_code = spillway::run_command(argc, argv);
    spillway::leave_ranks();
    return exit_code;
  } catch (...) {
    return spillway::report_failure(std::current_exception());
  }
}

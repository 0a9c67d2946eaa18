#include <exception>
#include <new>

#include "src/error.h"
#include "tools/command.h"
#include "tools/interrupts.h"
#include "tools/rank_job.h"

int main(int argc, char** argv) {
  using spillway::report_error;
  spillway::handle_interrupts();
  try {
    const int exit_code = spillway::run_command(argc, argv);
    spillway::leave_ranks();
    return exit_code;
  } catch (const spillway::ClosedPipe&) {
    return spillway::end_quietly(spillway::kExitClosedPipe);
  } catch (const spillway::UsageError& error) {
    return report_error(error.what(), spillway::kExitUsage);
  } catch (const std::bad_alloc&) {
    return report_error(
        "not enough memory: triangulate a part of the points, or use a larger machine",
        spillway::kExitFailed);
  } catch (const std::exception& error) {
    return report_error(error.what(), spillway::kExitFailed);
  }
}

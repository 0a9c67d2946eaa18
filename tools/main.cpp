#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string_view>

#include "src/error.h"
#include "tools/command.h"
#include "tools/interrupts.h"

namespace {

int complain(std::string_view message, int exit_code) {
  fmt::print(stderr, "spillway: error: {}\n", message);
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  spillway::handle_interrupts();
  try {
    return spillway::run_command(argc, argv);
  } catch (const spillway::ClosedPipe&) {
    return spillway::kExitClosedPipe;
  } catch (const spillway::UsageError& error) {
    return complain(error.what(), spillway::kExitUsage);
  } catch (const std::bad_alloc&) {
    return complain("not enough memory: triangulate a part of the points, or use a larger machine",
                    spillway::kExitFailed);
  } catch (const std::exception& error) {
    return complain(error.what(), spillway::kExitFailed);
  }
}

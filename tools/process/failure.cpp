#include "tools/process/failure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "formats/disk/unfinished_files.h"
#include "src/error.h"
#include "tools/process/exit_code.h"
#include "tools/process/rank_job.h"
#include "tools/report/standard_error.h"

namespace spillway::command {
namespace {

/// Ends the process with exit code 1 where there is not even memory for an exception, which would
/// end it by a signal. Before anything else of the program, as what is made before main may throw.
[[gnu::constructor(101)]] void refuse_to_run_without_memory() {
  // What exceptions take, with room. Freed, it stays with the heap: more would be mapped apart.
  constexpr std::size_t kLeast = std::size_t{96} << 10;
  void* const volatile some = std::malloc(kLeast);  // volatile: not to be left out
  if (some != nullptr) return std::free(some);
  constexpr std::string_view kText =
      "spillway: error: no memory to begin with: the limit of memory is reached (ulimit -v); raise "
      "it\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kText.data(), kText.size());
  _exit(kExitFailed);
}

/// The limit of a resource in words that end in `unit`, or nothing if there is none.
std::string limit_of(int resource, std::string_view option, std::uint64_t unit) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return "";
  return fmt::format("ulimit -{} is {}", option, limit.rlim_cur / unit);
}

std::string memory_limit_in_words() {
  constexpr std::uint64_t kUnit = 1024;
  const std::string of_addresses = limit_of(RLIMIT_AS, "v", kUnit);
  return of_addresses.empty() ? limit_of(RLIMIT_DATA, "d", kUnit) : of_addresses;
}

std::string no_memory() {
  const std::string limit = memory_limit_in_words();
  if (!limit.empty()) {
    return fmt::format("not enough memory: {}; raise that, or give a smaller --memory", limit);
  }
  return "not enough memory: give a smaller --memory, take a part of the points, or use a larger "
         "machine";
}

std::string no_thread() {
  std::string limits = limit_of(RLIMIT_NPROC, "u", 1);
  if (const std::string memory = memory_limit_in_words(); !memory.empty()) {
    limits += (limits.empty() ? "" : ", ") + memory;
  }
  return fmt::format(
      "cannot start a thread: the limit of processes or of memory is reached{}; raise it, or use "
      "fewer --threads",
      limits.empty() ? "" : fmt::format(" ({})", limits));
}

/// What oneTBB throws has no type of its own.
bool is_of_a_thread(std::string_view what) { return what.starts_with("pthread_create"); }

}  // namespace

std::string words_of(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return no_memory();
  const auto* const of_system = dynamic_cast<const std::system_error*>(&error);
  const bool of_thread = of_system != nullptr
                             ? of_system->code() == std::errc::resource_unavailable_try_again
                             : is_of_a_thread(error.what());
  return of_thread ? no_thread() : error.what();
}

namespace {

/// Says what was thrown; the exit code.
int report(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const ClosedPipe&) {
    return end_quietly(kExitClosedPipe);
  } catch (const InvalidArgument& error) {
    return report_error(error, kExitUsage);
  } catch (const Failure& error) {
    return report_error(error, kExitFailed);
  } catch (const std::exception& error) {
    return report_error(Failure(words_of(error)), kExitFailed);
  }
}

}  // namespace

int report_failure(const std::exception_ptr& failure) noexcept {
  static std::atomic_flag begun;
  while (begun.test_and_set()) ::pause();  // another thread ends the run
  try {
    return report(failure);
  } catch (...) {
    write_to_standard_error("spillway: error: not enough memory\n");
    return end_quietly(kExitFailed);
  }
}

std::string temporary_paths_left_in_words() {
  const std::vector<std::string> paths = temporary_paths_left();
  if (paths.empty()) return "";
  return fmt::format("cannot remove what is temporary: {}; remove it by hand",
                     fmt::join(paths, ", "));
}

void tell_of_temporary_paths_left() noexcept {
  try {
    const std::string words = temporary_paths_left_in_words();
    if (!words.empty()) write_warning(words);
  } catch (const std::exception&) {  // no memory for words
  }
}

void handle_uncaught_exceptions() {
  std::set_terminate([] {
    const std::exception_ptr thrown = std::current_exception();
    const int exit_code = report_failure(
        thrown ? thrown
               : std::make_exception_ptr(Failure("a fault of the program itself ends it")));
    remove_unfinished_files();
    tell_of_temporary_paths_left();
    _exit(exit_code);
  });
}

}  // namespace spillway::command

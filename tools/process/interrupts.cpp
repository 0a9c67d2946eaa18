#include "tools/process/interrupts.h"

#include <fmt/format.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "formats/disk/unfinished_files.h"
#include "src/distributed/ranks.h"
#include "tools/process/failure.h"
#include "tools/report/standard_error.h"

namespace spillway::command {
namespace {

/// How long an interrupted rank stays when it is done. mpirun kills all a second after it has told
/// them to end, but at once when the first has ended: others may still be removing files.
constexpr std::chrono::milliseconds kOtherRanks{900};

std::string message_of(int number, std::vector<std::string> outputs) {
  constexpr std::size_t kMostNamed = 3;
  std::string text = fmt::format("interrupted by SIG{}", sigabbrev_np(number));
  if (outputs.empty()) return text;
  const std::size_t more = outputs.size() - std::min(outputs.size(), kMostNamed);
  outputs.resize(outputs.size() - more);
  text += fmt::format("; nothing was written to {}", fmt::join(outputs, ", "));
  return more == 0 ? text : fmt::format("{} and {} more", text, more);
}

struct FirstAction {
  std::mutex mutex;
  std::function<void()> what;  // guarded by mutex, as is the next one
  std::string advice{};
};

FirstAction& first_action() {
  static FirstAction instance;
  return instance;
}

sigset_t interrupts() {
  sigset_t all;
  sigemptyset(&all);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&all, number);
  return all;
}

[[noreturn]] void end_run(int number, bool tell) {
  const std::lock_guard lock(first_action().mutex);
  try {
    if (first_action().what) first_action().what();
    const std::vector<std::string> outputs = remove_unfinished_files();
    const std::string left = temporary_paths_left_in_words();
    if (tell) {
      last_message(message_of(number, outputs) + first_action().advice +
                   (left.empty() ? "" : "; " + left));
    }
  } catch (const std::exception&) {  // no memory for words
  }
  if (distributed::launch().ranks > 1) std::this_thread::sleep_for(kOtherRanks);
  _exit(128 + number);
}

}  // namespace

void block_interrupts() {
  const sigset_t signals = interrupts();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

void handle_interrupts() {
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  std::thread([signals = interrupts(), tell = distributed::launch().rank == 0] {
    int number = 0;
    while (sigwait(&signals, &number) != 0) {
    }
    end_run(number, tell);
  }).detach();
}

InterruptAction::InterruptAction(std::function<void()> action) {
  const std::lock_guard lock(first_action().mutex);
  first_action().what = std::move(action);
}

InterruptAction::~InterruptAction() {
  const std::lock_guard lock(first_action().mutex);
  first_action().what = nullptr;
}

InterruptAdvice::InterruptAdvice(std::string advice) {
  const std::lock_guard lock(first_action().mutex);
  first_action().advice = "; " + std::move(advice);
}

InterruptAdvice::~InterruptAdvice() {
  const std::lock_guard lock(first_action().mutex);
  first_action().advice.clear();
}

}  // namespace spillway::command

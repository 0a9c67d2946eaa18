#include "tools/process/interrupts.h"

#include <fmt/format.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "formats/disk/unfinished_files.h"
#include "src/distributed/ranks.h"
#include "tools/report/standard_error.h"

namespace spillway::detail {
namespace {

std::string message_of(int number, std::vector<std::string> outputs) {
  constexpr std::size_t kMostNamed = 3;
  std::string text = fmt::format("interrupted by SIG{}", sigabbrev_np(number));
  if (outputs.empty()) return text;
  const std::size_t more = outputs.size() - std::min(outputs.size(), kMostNamed);
  outputs.resize(outputs.size() - more);
  text += fmt::format("; nothing was written to {}", fmt::join(outputs, ", "));
  return more == 0 ? text : fmt::format("{} and {} more", text, more);
}

[[noreturn]] void end_run(int number, bool tell) {
  try {
    const std::vector<std::string> outputs = remove_unfinished_files();
    if (tell) last_message(message_of(number, outputs));
  } catch (const std::exception&) {  // no memory for words
  }
  _exit(128 + number);
}

}  // namespace

void handle_interrupts() {
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  sigset_t interrupts;
  sigemptyset(&interrupts);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&interrupts, number);
  pthread_sigmask(SIG_BLOCK, &interrupts, nullptr);
  std::thread([interrupts, tell = distributed::launch().rank == 0] {
    int number = 0;
    while (sigwait(&interrupts, &number) != 0) {
    }
    end_run(number, tell);
  }).detach();
}

}  // namespace spillway::detail

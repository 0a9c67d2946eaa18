#include "tools/report/standard_error.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <mutex>
#include <string>

#include "tools/report/json_text.h"
#include "tools/report/printable_text.h"

namespace spillway::command {
namespace {

constexpr std::chrono::milliseconds kLongestWait{200};

std::atomic<MessageStyle> message_style = MessageStyle::kText;

/// Writers take turns.
struct Turns {
  std::timed_mutex mutex;
  bool closed = false;  // guarded by mutex
};

Turns& turns() {
  static Turns instance;
  return instance;
}

void write_all(std::string_view text) {
  while (!text.empty()) {
    const ssize_t put = ::write(STDERR_FILENO, text.data(), text.size());
    if (put > 0) {
      text.remove_prefix(static_cast<std::size_t>(put));
    } else if (put == 0 || errno != EINTR) {
      return;
    }
  }
}

std::string styled(std::string_view message) {
  switch (message_style) {
    case MessageStyle::kJson:
      return json_text({{"message", message}}) + "\n";
    case MessageStyle::kTerminal:
      return fmt::format("\r\x1b[Kspillway: {}\n", printable(message));
    case MessageStyle::kText:
      break;
  }
  return fmt::format("spillway: {}\n", printable(message));
}

}  // namespace

void set_message_style(MessageStyle style) { message_style = style; }

void write_to_standard_error(std::string_view text) {
  const std::lock_guard turn(turns().mutex);
  if (!turns().closed) write_all(text);
}

void write_error(std::string_view message) {
  write_to_standard_error(fmt::format("spillway: error: {}\n", printable(message)));
}

void write_warning(std::string_view message) {
  write_to_standard_error(fmt::format("spillway: warning: {}\n", printable(message)));
}

void last_message(std::string_view message) {
  const std::unique_lock turn(turns().mutex, kLongestWait);
  if (!turn.owns_lock()) return;  // somebody waits for standard error to take more
  turns().closed = true;
  pollfd ready{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
  const bool takes_more = ::poll(&ready, 1, static_cast<int>(kLongestWait.count())) > 0 &&
                          (ready.revents & POLLOUT) != 0;
  if (takes_more) write_all(styled(message));
}

}  // namespace spillway::command

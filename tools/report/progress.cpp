#include "tools/report/progress.h"

#include <algorithm>
#include <system_error>

#include "tools/report/json_text.h"
#include "tools/report/printable_text.h"
#include "tools/report/standard_error.h"

namespace spillway::command {
namespace {

MessageStyle message_style(ProgressStyle style) {
  switch (style) {
    case ProgressStyle::kTerminal:
    case ProgressStyle::kEndsOnTerminal:
      return MessageStyle::kTerminal;
    case ProgressStyle::kJson:
      return MessageStyle::kJson;
    default:
      return MessageStyle::kText;
  }
}

std::chrono::milliseconds period(ProgressStyle style) {
  switch (style) {
    case ProgressStyle::kTerminal:
      return std::chrono::milliseconds(100);
    case ProgressStyle::kJson:
      return std::chrono::seconds(1);
    default:
      return std::chrono::seconds(5);
  }
}

}  // namespace

ProgressLine::ProgressLine(ProgressStyle style, bool quiet, bool verbose)
    : style_(style), quiet_(quiet), verbose_(verbose) {
  set_message_style(message_style(style));
}

ProgressLine::~ProgressLine() { give_up(); }

void ProgressLine::Phase::update(std::uint64_t done, std::optional<double> fraction) {
  state.done = std::max(state.done, done);
  state.fraction = fraction ? std::max(state.fraction, fraction) : std::nullopt;
}

void ProgressLine::Phase::finish(std::uint64_t done) {
  state.done = done;
  state.finished = true;
  state.seconds = std::chrono::duration<double>(Clock::now() - start).count();
}

void ProgressLine::begin(const std::string& phase, const std::string& unit) {
  {
    const std::lock_guard lock(mutex_);
    phase_ = {Clock::now(), {.phase = phase, .unit = unit, .fraction = {}}};
  }
  if (style_ == ProgressStyle::kNone || style_ == ProgressStyle::kEndsOnTerminal) return;
  try {
    ticker_ = std::jthread([this](const std::stop_token& stop) { tick_until_stopped(stop); });
  } catch (const std::system_error&) {
    // No more threads to be had: the phase goes on without lines about it, but for the last one.
  }
}

void ProgressLine::update(std::uint64_t done, std::optional<double> fraction) {
  const std::lock_guard lock(mutex_);
  phase_.update(done, fraction);
}

double ProgressLine::end(std::uint64_t done) {
  ticker_ = {};
  const std::lock_guard lock(mutex_);
  phase_.finish(done);
  show_end(phase_.state, lock);
  return phase_.state.seconds;
}

void ProgressLine::begin_inner(const std::string& phase, const std::string& unit) {
  const std::lock_guard lock(mutex_);
  inner_ = {Clock::now(), {.phase = phase, .unit = unit, .fraction = {}}};
}

void ProgressLine::update_inner(std::uint64_t done, std::optional<double> fraction) {
  const std::lock_guard lock(mutex_);
  if (inner_) inner_->update(done, fraction);
}

void ProgressLine::end_inner(std::uint64_t done) {
  const std::lock_guard lock(mutex_);
  if (!inner_) return;
  inner_->finish(done);
  show_end(inner_->state, lock);
  inner_.reset();
}

void ProgressLine::tell(const Progress& state) {
  using Event = spillway::Progress::Event;
  switch (state.event) {
    case Event::kBegun:
      state.nested ? begin_inner(std::string(state.phase), std::string(state.unit))
                   : begin(std::string(state.phase), std::string(state.unit));
      break;
    case Event::kUpdated:
      state.nested ? update_inner(state.done, state.fraction) : update(state.done, state.fraction);
      break;
    case Event::kEnded:
      if (state.nested) {
        end_inner(state.done);
      } else {
        end(state.done);
      }
      break;
  }
}

void ProgressLine::give_up() {
  ticker_ = {};
  const std::lock_guard lock(mutex_);
  inner_.reset();
  wipe(lock);
}

void ProgressLine::say(std::string_view message) {
  if (!quiet_) insist(message);
}

void ProgressLine::insist(std::string_view message) {
  const std::lock_guard lock(mutex_);
  wipe(lock);
  if (style_ == ProgressStyle::kJson) {
    write_to_standard_error(json_text({{"message", message}}) + "\n");
  } else {
    write_to_standard_error("spillway: " + printable(message) + "\n");
  }
}

void ProgressLine::detail(std::string_view message) {
  if (verbose_) say(message);
}

bool ProgressLine::rewrites() const { return style_ == ProgressStyle::kTerminal; }

void ProgressLine::tick_until_stopped(const std::stop_token& stop) {
  std::unique_lock sleep(sleep_mutex_);
  const auto never = [] { return false; };
  while (true) {
    stopped_.wait_for(sleep, stop, period(style_), never);
    if (stop.stop_requested()) return;
    const std::lock_guard lock(mutex_);
    Phase& shown = inner_ ? *inner_ : phase_;
    shown.state.seconds = std::chrono::duration<double>(Clock::now() - shown.start).count();
    show(shown.state, lock);
  }
}

void ProgressLine::show_end(const PhaseState& state,
                            const std::lock_guard<std::mutex>& lock) const {
  if (rewrites()) {
    wipe(lock);
  } else {
    show(state, lock);
  }
}

void ProgressLine::show(const PhaseState& state, const std::lock_guard<std::mutex>& lock) const {
  switch (style_) {
    case ProgressStyle::kNone:
      break;
    case ProgressStyle::kPlain:
      write_to_standard_error("spillway: " + progress_line(state) + "\n");
      break;
    case ProgressStyle::kEndsOnTerminal:
      write_to_standard_error("\r\x1b[Kspillway: " + progress_line(state) + "\n");
      break;
    case ProgressStyle::kTerminal:
      wipe(lock);
      write_to_standard_error(progress_line(state));
      break;
    case ProgressStyle::kJson:
      write_to_standard_error(progress_json(state) + "\n");
      break;
  }
}

void ProgressLine::wipe(const std::lock_guard<std::mutex>& /*lock*/) const {
  if (rewrites()) write_to_standard_error("\r\x1b[K");
}

}  // namespace spillway::command

#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

namespace spillway::python {

/// How soon a signal is noticed: short for people, long for processors.
inline constexpr std::chrono::milliseconds kPatience{50};

/// What a run says in words.
struct Message {
  bool is_warning = true;  ///< else it explains how the run goes
  std::string text;
};

/// What a run and the thread that called for it tell each other. For any thread.
class Watch {
 public:
  void tell(double fraction) { fraction_ = fraction; }
  void say(bool is_warning, std::string_view text);
  [[nodiscard]] std::stop_token stop_token() const { return stop_.get_token(); }

  [[nodiscard]] double fraction() const { return fraction_; }
  std::vector<Message> take_messages();
  void request_stop() { stop_.request_stop(); }

 private:
  std::atomic<double> fraction_ = 0;
  std::stop_source stop_;
  std::mutex mutex_;
  std::vector<Message> messages_;  // guarded by mutex_
};

/// Brings what a run tells into Python, in the thread that called. All with the interpreter's lock.
class Listener {
 public:
  /// `progress` is a callable that takes a fraction, or None. `watch` must outlive it.
  Listener(Watch& watch, pybind11::object progress);

  /// Looks for signals, and passes on warnings and the fraction that is done, each fraction once.
  /// Throws what a signal's handler (KeyboardInterrupt), a filter of warnings or `progress` raises.
  void listen();
  /// The same when all is done.
  void complete();

 private:
  void tell(double fraction);

  Watch& watch_;
  pybind11::object progress_;
  double told_ = 0;
};

/// Runs `work` without the interpreter's lock, in a thread of its own, while the caller's thread
/// listens: everything of Python happens in the thread that called. Throws what `work` throws.
/// After an exception of Python the work is told to stop; when it has, that exception is thrown.
void run_watched(Watch& watch, Listener& listener, const std::function<void()>& work);

}  // namespace spillway::python

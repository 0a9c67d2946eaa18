#pragma once

#include <spillway/context.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "tools/report/progress_line.h"

namespace spillway::command {

enum class ProgressStyle {
  kNone,
  kPlain,     ///< a line at the end of a phase and every few seconds
  kTerminal,  ///< one line that is rewritten ten times a second
  /// A line at the end of a phase on a terminal on which another process rewrites one.
  kEndsOnTerminal,
  kJson,  ///< a JSON object a line, every second and at the end of a phase; messages likewise
};

/// All that a run says on standard error, errors excepted: progress and messages. The work is a
/// sequence of phases. While one lasts, a thread of its own shows how far it is, so the work itself
/// only counts. All functions may be called from any thread.
class ProgressLine {
 public:
  /// `quiet` silences say(), `verbose` lets detail() speak.
  ProgressLine(ProgressStyle style, bool quiet, bool verbose);

  /// Wipes a line that is being rewritten, so that an error message finds a clean one.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void begin(const std::string& phase, const std::string& unit);
  /// Says how far the phase is. Of what several threads say, in any order, the most counts; a
  /// fraction that has become unknown is not shown.
  void update(std::uint64_t done, std::optional<double> fraction);
  /// Ends the phase, in which `done` units were done, and returns how many seconds it took.
  double end(std::uint64_t done);
  /// The same for a phase within the one that goes on, which is shown in its place. Meanwhile
  /// update() is still about the outer one.
  void begin_inner(const std::string& phase, const std::string& unit);
  void update_inner(std::uint64_t done, std::optional<double> fraction);
  void end_inner(std::uint64_t done);
  /// What the library tells of a run: one of the functions above.
  void tell(const Progress& state);
  /// Ends a phase that failed, or none, without a line about it.
  void give_up();

  /// A message, unless quiet.
  void say(std::string_view message);
  /// A message that is said with -q, too.
  void insist(std::string_view message);
  /// A message that only -v shows.
  void detail(std::string_view message);

 private:
  using Clock = std::chrono::steady_clock;

  struct Phase {
    Clock::time_point start;
    PhaseState state;

    void update(std::uint64_t done, std::optional<double> fraction);
    void finish(std::uint64_t done);
  };

  [[nodiscard]] bool rewrites() const;
  void tick_until_stopped(const std::stop_token& stop);
  void show_end(const PhaseState& state, const std::lock_guard<std::mutex>& lock) const;
  void show(const PhaseState& state, const std::lock_guard<std::mutex>& lock) const;
  void wipe(const std::lock_guard<std::mutex>& lock) const;

  const ProgressStyle style_;
  const bool quiet_;
  const bool verbose_;
  std::mutex mutex_;  // guards the next three and what stands on standard error
  Phase phase_;
  std::optional<Phase> inner_;
  std::mutex sleep_mutex_;
  std::condition_variable_any stopped_;
  std::jthread ticker_;
};

}  // namespace spillway::command

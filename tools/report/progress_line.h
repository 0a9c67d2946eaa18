#pragma once
// How progress looks, apart from where and when it is shown.

#include <cstdint>
#include <optional>
#include <string>

#include "src/rooms.h"

namespace spillway::command {

/// Where a phase of the work is.
struct PhaseState {
  std::string phase;               ///< what is being done: "read", "triangulate", "write", ...
  std::string unit;                ///< what `done` counts: "points", ...
  std::uint64_t done = 0;          ///< units
  std::optional<double> fraction;  ///< of the whole phase, from 0 to 1, where known
  double seconds = 0;              ///< since the phase began
  bool finished = false;

  /// Units per second; 0 while there is nothing to tell.
  [[nodiscard]] double rate() const;
  /// Seconds to go, where the fraction is known and not 0.
  [[nodiscard]] std::optional<double> seconds_left() const;
};

/// One line for people: "read: 1.2M points, 3.4M points/s, 35%, 0:12 left", "triangulate: 0:05".
std::string progress_line(const PhaseState& state);

/// One JSON object for programs, without the line's end. Its keys are listed in docs/cli.md.
std::string progress_json(const PhaseState& state);

/// 950, 12.3k, 1.20M, 3.40G: three digits, so that a rewritten line doesn't dance.
std::string short_number(double number);

/// 0:05, 12:34, 1:02:03.
std::string clock_time(double seconds);

}  // namespace spillway::command

#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "src/rooms.h"

namespace spillway::stream {

/// Who is told how far a run is. What it throws ends the run.
class RunProgress {
 public:
  virtual ~RunProgress() = default;

  /// A phase begins: "read", "divide" if there are tiles to be divided again, "triangulate"; and
  /// has ended, with all points that have been through it.
  virtual void begin_phase(const char* /*phase*/) {}
  virtual void end_phase(std::uint64_t /*points*/) {}
  /// How many points have been through the phase, and what share of all that is, if it is known. By
  /// many threads.
  virtual void tell(std::uint64_t /*points*/, std::optional<double> /*fraction*/) {}
  /// What users should know.
  virtual void warn(std::string_view /*text*/) {}
};

}  // namespace spillway::stream

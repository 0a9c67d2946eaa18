#pragma once

#include <spillway/context.h>

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "src/runtime/run_memory.h"
#include "stream/plan/run_progress.h"

namespace spillway::stream {

/// Tells a program how far its run is, one call at a time, and ends the run when the program asks
/// for it. All functions may be called by many threads; what the run keeps (RunMemory) lasts as
/// long, so the thread that makes it destroys it.
class RunWatch : public RunProgress {
 public:
  /// `context` must outlive it.
  explicit RunWatch(const Context& context);

  /// Throws Interrupted if the run is to be stopped, as do tell() and check().
  void begin(const std::string& phase, const std::string& unit);
  void tell(std::uint64_t done, std::optional<double> fraction) override;
  /// Stops nothing: what the phase was for is done. Returns how many seconds it took.
  double end(std::uint64_t done);
  /// A phase for all that follows, until close(): phases that begin and end meanwhile are not told.
  void open(const std::string& phase, const std::string& unit);
  void close(std::uint64_t done);
  /// The same for a phase within the one that goes on; meanwhile tell() is still about that.
  void begin_nested(const std::string& phase, const std::string& unit);
  void tell_nested(std::uint64_t done, std::optional<double> fraction);
  void end_nested(std::uint64_t done);
  void check() const;

  /// Phases of an engine, which count points.
  void begin_phase(const char* phase) override { begin(phase, "points"); }
  void end_phase(std::uint64_t points) override { end(points); }
  void warn(std::string_view text) override {
    if (options_.warning) options_.warning(text);
  }

 private:
  struct Phase {
    std::string name{};
    std::string unit{};
    std::chrono::steady_clock::time_point start{};
    bool nested = false;
    std::uint64_t told = 0;
  };

  void start(Phase& phase, const std::string& name, const std::string& unit);
  void report(Phase& phase, Progress::Event event, std::uint64_t done,
              std::optional<double> fraction);

  const RunScope run_;
  const ContextOptions& options_;
  std::mutex& mutex_;  // of the context; guards what follows
  Phase phase_;
  bool is_open_ = false;  ///< phase_ is for all that follows
  Phase nested_{.nested = true};
};

}  // namespace spillway::stream

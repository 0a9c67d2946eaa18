#pragma once

#include <spillway/context.h>

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

namespace spillway::detail {

/// Tells a program how far its run is, one call at a time, and ends the run when the program asks
/// for it. All functions may be called by many threads.
class RunWatch {
 public:
  /// `context` must outlive it.
  explicit RunWatch(const Context& context) : options_(context.options()) {}

  /// Throws Interrupted if the run is to be stopped, as do tell() and check().
  void begin(const char* phase);
  void tell(std::uint64_t done, std::optional<double> fraction);
  /// Stops nothing: what the phase was for is done.
  void end(std::uint64_t done);
  void check() const;

 private:
  void report(std::uint64_t done, std::optional<double> fraction);

  const ContextOptions& options_;
  std::mutex mutex_;
  std::string phase_;       // guarded by mutex_, as is what follows
  std::uint64_t told_ = 0;  // in this phase
};

}  // namespace spillway::detail

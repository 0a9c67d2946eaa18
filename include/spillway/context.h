#pragma once
// What a run may take, and how it is watched and stopped.

#include <spillway/export.h>

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

namespace spillway {

namespace stream {
class ContextState;
}

/// How far a run is: it is a sequence of phases.
struct Progress {
  enum class Event {
    kBegun,    ///< the phase
    kUpdated,  ///< `done` and `fraction`
    kEnded,    ///< the phase, which is complete
  };
  Event event = Event::kUpdated;
  std::string_view phase;          ///< "read", "divide", "triangulate", "write", ...
  std::string_view unit;           ///< what is counted: "points", "triangles", "pixels", ...
  std::uint64_t done = 0;          ///< how many have been through the phase
  std::optional<double> fraction;  ///< of the phase, from 0 to 1, where that is known
  bool nested = false;             ///< a phase within the one that goes on, which is not over
};

/// Processes that share runs, as those of mpirun; the command makes one.
class Executor;

/// An amount of memory: a number of bytes, or a text such as "512M" or "2G", where K, M, G, T are
/// powers of 1024. What is none is refused by whoever takes it.
class MemorySize {
 public:
  /// Not said.
  MemorySize() = default;
  template <std::integral Number>
  MemorySize(Number bytes)  // NOLINT(google-explicit-constructor): written as a number
      : text_(std::to_string(bytes)) {}
  MemorySize(std::string text)  // NOLINT(google-explicit-constructor): written as a text
      : text_(std::move(text)) {}
  MemorySize(const char* text)  // NOLINT(google-explicit-constructor): likewise
      : text_(text) {}

  [[nodiscard]] bool empty() const { return text_.empty(); }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

struct ContextOptions {
  /// Memory to keep to: 32M at least, for tetrahedra 96M. Empty: a quarter of what this process may
  /// use, 2G at most.
  MemorySize memory{};
  /// The most threads, the caller's among them; 0: as many as this process may use.
  unsigned threads = 0;
  /// Where scratch files go that do not fit into memory. Empty: $TMPDIR, else /tmp.
  std::string scratch_folder{};
  /// Most that may lie there at a time. Empty: no limit.
  MemorySize scratch_limit{};
  /// Told from time to time how far the run is, by any thread, one call at a time.
  std::function<void(const Progress&)> progress{};
  /// Told what is worth a warning, and what explains how the run goes; by any thread.
  std::function<void(std::string_view)> warning{};
  std::function<void(std::string_view)> detail{};
  /// A request to stop ends the run with ErrorCode::kInterrupted, soon but not at once: parts of
  /// some ten thousand points that have been begun are finished, and so is the last phase, "write".
  std::stop_token stop{};
  /// Who does the work; empty: this process.
  std::shared_ptr<Executor> executor{};
};

/// What the calls of a program have in common. Nothing of it is kept by the process: two contexts
/// beside each other do not know of each other. It may be used by several calls, also at a time.
/// Only what the process has one of is shared: its allocator, to which a run gives what it frees,
/// and which gives that to the system when all runs under way hold more than the sum of their
/// limits; and oneTBB's threads, which wait for the next call and end with the last context.
class SPILLWAY_API Context {
 public:
  /// Throws Error(kInvalidArgument) for sizes that are none, or more than 4,096 threads.
  explicit Context(ContextOptions options = {});

  [[nodiscard]] const ContextOptions& options() const { return options_; }
  /// Bytes to keep to.
  [[nodiscard]] std::uint64_t memory() const { return memory_; }
  [[nodiscard]] unsigned threads() const { return threads_; }
  /// Bytes of scratch files, where there is a limit.
  [[nodiscard]] const std::optional<std::uint64_t>& scratch_limit() const { return scratch_limit_; }

  /// For the library itself: what calls have in common besides. Copies of a context share it.
  [[nodiscard]] stream::ContextState& state() const { return *state_; }

 private:
  ContextOptions options_;
  std::uint64_t memory_ = 0;
  unsigned threads_ = 1;
  std::optional<std::uint64_t> scratch_limit_;
  std::shared_ptr<stream::ContextState> state_;
};

}  // namespace spillway

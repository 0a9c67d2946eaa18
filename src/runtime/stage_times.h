#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string_view>
#include <utility>

#include "src/rooms.h"

namespace spillway::runtime {

/// Where the threads of a run spend their time.
enum class Stage {
  kRead,      ///< decoding the input
  kExchange,  ///< moving points between ranks: finding each one's, encoding, sending, waiting
  kDeal,      ///< finding each point's tile
  kSpill,     ///< encoding points and writing them to the scratch files
  kLoad,      ///< reading and decoding tiles
  kDivide,    ///< of loaded tiles into leaves
  kLeaves,    ///< triangulating leaves
  kFinality,  ///< finding out what is final, and making blocks of it
  kMerge,     ///< triangulating borders
  kEncode,    ///< compressing blocks of the output
  kWrite,     ///< the output
};

inline constexpr std::array kStageNames = {"read",  "exchange", "deal",   "spill",
                                           "load",  "divide",   "leaves", "finality",
                                           "merge", "encode",   "write"};

/// Processor time that the calling thread has had.
double processor_seconds();
/// The same of all threads of the process.
double process_processor_seconds();

/// Whether many threads may do steps of a kind at the same time, or one after the other.
enum class StepOrder : std::uint8_t { kAny, kInOrder };

/// A stretch of the work of one thread, as those that StageTimes adds up.
struct StageStep {
  std::string_view stage;     ///< of kStageNames
  bool in_order = false;      ///< of a kind that one thread at a time does, in order
  double seconds = 0;         ///< wall time
  double processor_time = 0;  ///< of the thread, in seconds
  std::uint64_t bytes = 0;    ///< that were read or written; 0: none, or not known
};

/// Seconds of all threads together, by stage; added to by many threads at once.
class StageTimes {
 public:
  [[nodiscard]] double seconds(Stage stage) const {
    return static_cast<double>(times_[static_cast<std::size_t>(stage)]) * 1e-9;
  }
  void add(Stage stage, std::chrono::nanoseconds time) {
    times_[static_cast<std::size_t>(stage)] += time.count();
  }

  /// From now on `step_done`, which must not throw, is told every step, by the thread that has done
  /// it, one at a time. To be called before the first.
  void tell_steps(std::function<void(const StageStep&)> step_done) {
    step_done_ = std::move(step_done);
  }
  [[nodiscard]] bool tells_steps() const { return static_cast<bool>(step_done_); }
  void tell(StageStep step);

 private:
  std::array<std::atomic<std::int64_t>, kStageNames.size()> times_{};
  std::function<void(const StageStep&)> step_done_;
  std::mutex tell_mutex_;  ///< held while step_done_ is called
};

/// Adds the time between its construction and its destruction to a stage.
class StageTimer {
 public:
  StageTimer(StageTimes& times, Stage stage, StepOrder order = StepOrder::kAny)
      : times_(times),
        stage_(stage),
        order_(order),
        processor_start_(times.tells_steps() ? processor_seconds() : 0),
        start_(Clock::now()) {}
  ~StageTimer() {
    const Clock::duration time = Clock::now() - start_;
    times_.add(stage_, time);
    if (!times_.tells_steps()) return;
    times_.tell({.stage = kStageNames[static_cast<std::size_t>(stage_)],
                 .in_order = order_ == StepOrder::kInOrder,
                 .seconds = std::chrono::duration<double>(time).count(),
                 .processor_time = processor_seconds() - processor_start_,
                 .bytes = bytes_});
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

  /// Counts bytes that this step reads or writes.
  void move_bytes(std::uint64_t bytes) { bytes_ += bytes; }

 private:
  using Clock = std::chrono::steady_clock;
  StageTimes& times_;
  Stage stage_;
  StepOrder order_;
  std::uint64_t bytes_ = 0;
  double processor_start_;
  Clock::time_point start_;
};

}  // namespace spillway::runtime

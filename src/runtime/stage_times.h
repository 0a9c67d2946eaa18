#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>

namespace spillway::detail {

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

/// Seconds of all threads together, by stage; added to by many threads at once.
class StageTimes {
 public:
  [[nodiscard]] double seconds(Stage stage) const {
    return static_cast<double>(times_[static_cast<std::size_t>(stage)]) * 1e-9;
  }
  void add(Stage stage, std::chrono::nanoseconds time) {
    times_[static_cast<std::size_t>(stage)] += time.count();
  }

 private:
  std::array<std::atomic<std::int64_t>, kStageNames.size()> times_{};
};

/// Adds the time between its construction and its destruction to a stage.
class StageTimer {
 public:
  StageTimer(StageTimes& times, Stage stage) : times_(times), stage_(stage), start_(Clock::now()) {}
  ~StageTimer() { times_.add(stage_, Clock::now() - start_); }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  StageTimes& times_;
  Stage stage_;
  Clock::time_point start_;
};

}  // namespace spillway::detail

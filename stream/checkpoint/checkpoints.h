#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include "stream/checkpoint/checkpoint_folder.h"

namespace spillway::stream {

/// The checkpoints of a run: when the next one is due, and what they cost. Less often than is asked
/// for where they would take more than a fiftieth of the time.
class Checkpoints {
 public:
  /// `folder` must outlive it. One is due every `seconds`.
  Checkpoints(CheckpointFolder& folder, double seconds);

  /// Whether one is due in the midst of a phase, once work has come to rest; or at the end of one.
  /// For any thread.
  [[nodiscard]] bool due() const;
  [[nodiscard]] bool due_at_end_of_phase() const;

  /// No thread is at work.
  void save(const std::function<void(StateWriter&)>& write);
  /// Counts and times a checkpoint that is saved in another way.
  void measure(const std::function<void()>& save);

  [[nodiscard]] CheckpointFolder& folder() { return folder_; }
  /// How many there were, and what they took.
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double seconds() const { return total_.count(); }

 private:
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  [[nodiscard]] bool is_past(Seconds interval) const;

  CheckpointFolder& folder_;
  Seconds interval_;
  std::atomic<Clock::time_point> last_;
  std::atomic<double> cost_ = 0;  ///< of the last one, in seconds
  std::uint64_t count_ = 0;
  Seconds total_{0};
};

}  // namespace spillway::stream

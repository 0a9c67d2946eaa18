#pragma once
// Time as it passes in a simulation: cores, and a disk.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "src/rooms.h"

namespace spillway::command {

/// What comes first when a core falls free.
enum class Urgency : std::uint8_t {
  kLeaf,
  kMerge,
  kLoad,
  kTopMerge,
  kBatch,
  kInOrder,  ///< what only one thread at a time can do
};

/// Cores, each of which does one piece of work at a time, and a disk that moves bytes for one after
/// the other. Who waits for the disk leaves its core to others, as a system does that reads ahead
/// and writes behind.
class SimulatedMachine {
 public:
  using Then = std::function<void()>;

  /// `disk_speed` is bytes a second; 0: the disk takes no time.
  SimulatedMachine(unsigned cores, double disk_speed) : idle_(cores), disk_speed_(disk_speed) {}

  /// Calls `then` when some core has worked for so long.
  void compute(double seconds, Urgency urgency, Then then);
  /// The same with work that falls into equal grains.
  void compute(double seconds, std::size_t grains, Urgency urgency, Then then);
  /// Calls `then` when the disk has moved so many bytes.
  void move(double bytes, Then then);

  /// Lets time pass until there is nothing left to do. Returns when that was, in seconds.
  double run();

 private:
  struct Ready {
    Urgency urgency;
    std::uint64_t order;  ///< in which it became ready
    double seconds;
    Then then;

    /// Whether the other comes first.
    bool operator<(const Ready& other) const {
      return urgency != other.urgency ? urgency < other.urgency : order > other.order;
    }
  };
  struct Event {
    double time;
    std::uint64_t order;
    bool frees_core;
    Then then;

    /// Whether the other comes first.
    bool operator<(const Event& other) const {
      return time != other.time ? time > other.time : order > other.order;
    }
  };

  void start_ready();
  void at(double time, bool frees_core, Then then);

  unsigned idle_;
  double disk_speed_;
  double now_ = 0;
  double disk_free_ = 0;  ///< when it will have moved all that it was given
  std::uint64_t order_ = 0;
  std::vector<Ready> ready_;   ///< a heap
  std::vector<Event> events_;  ///< a heap
  std::deque<Then> at_once_;   ///< what takes no time
};

}  // namespace spillway::command

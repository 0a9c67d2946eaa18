#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/simulate/flat_task.h"
#include "tools/simulate/machine.h"

namespace spillway::command {

/// Plays tasks on a machine: steps one after the other, grains and children at the same time.
class TaskPlayer {
 public:
  explicit TaskPlayer(SimulatedMachine& machine) : machine_(machine) {}

  /// Calls `done` when all of the task is. The task must outlive that.
  void play(const FlatTask& task, Urgency urgency, SimulatedMachine::Then done);

 private:
  enum class Phase : std::uint8_t { kBefore, kOwn, kChildren, kAfter };

  /// A node of a task that has begun.
  struct State {
    const FlatTask* task = nullptr;
    std::uint32_t node = 0;
    std::uint32_t next = 0;   ///< of the nodes below it, that has not begun
    std::uint32_t left = 0;   ///< steps of this phase that have not begun
    std::size_t pending = 0;  ///< what the next step waits for
    std::size_t parent = 0;   ///< its state, if it is not the root
    Phase phase = Phase::kBefore;
    Urgency urgency{};
    SimulatedMachine::Then done{};  ///< of the root
  };

  std::size_t begin(const FlatTask& task, std::uint32_t node, Urgency urgency);
  void begin_below(std::size_t state);
  void advance(std::size_t state);
  void finish_one(std::size_t state);

  SimulatedMachine& machine_;
  std::vector<State> states_;
  std::vector<std::size_t> unused_;  ///< of these
};

}  // namespace spillway::command

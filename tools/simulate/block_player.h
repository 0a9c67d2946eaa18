#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/simulate/machine.h"
#include "tools/simulate/run_model.h"

namespace spillway::command {

/// Plays the writing of blocks: one at a time, in the order of nodes and their parts.
class BlockPlayer {
 public:
  /// Both must outlive it.
  BlockPlayer(const RunModel& model, SimulatedMachine& machine);

  void submit(std::uint32_t node, std::uint32_t part);

  /// Calls `then` when there is room for blocks to wait, or when it is the turn of that node. One
  /// at a time may wait.
  void wait_for_room(std::uint32_t node, SimulatedMachine::Then then);

  /// Calls `then` when the last block has been written.
  void when_all_written(SimulatedMachine::Then then);

 private:
  struct Waiter {
    std::uint32_t node;
    SimulatedMachine::Then then;
  };

  [[nodiscard]] const std::vector<PartCost>& parts_of(std::uint32_t node) const {
    return model_.costs[model_.nodes[node].cost].parts;
  }
  void write_next();
  void written();
  void tell_waiter();
  void tell_all_written();

  const RunModel& model_;
  SimulatedMachine& machine_;
  std::vector<std::vector<bool>> submitted_;  ///< by node and part
  std::uint32_t next_node_ = 0;
  std::uint32_t next_part_ = 0;
  bool writing_ = false;
  double waiting_bytes_ = 0;
  std::optional<Waiter> waiter_;
  SimulatedMachine::Then all_written_{};
};

}  // namespace spillway::command

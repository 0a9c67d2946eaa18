#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "tools/simulate/block_player.h"
#include "tools/simulate/machine.h"
#include "tools/simulate/run_model.h"
#include "tools/simulate/task_player.h"

namespace spillway::command {

/// Plays the work on tiles and their merges, as the engine goes about it: some lanes take what is
/// ready, in order; who is done with the last child of a merge goes on with that.
class TilePlayer {
 public:
  using Then = SimulatedMachine::Then;

  /// The first two must outlive it.
  TilePlayer(const RunModel& model, SimulatedMachine& machine, unsigned threads);

  /// The nodes up to that one can be worked on, as far as their children are done.
  void add_until(std::uint32_t end);
  [[nodiscard]] std::uint32_t added() const { return added_; }

  /// While points are being read: starts one more lane if there may be one, and works off what is
  /// too much by itself. Calls `then` when no more is ready than may be.
  void work_ahead(Then then);

  /// Calls `done` when the lanes have nothing left to do.
  void when_idle(Then done);

  /// As many lanes as there may be. Calls `done` when all nodes are done, and written.
  void work_off_all(Then done);

 private:
  /// A node that is being worked on.
  struct Work {
    std::uint32_t node = 0;
    std::vector<std::uint32_t> missing;  ///< children, by part
    Then done;
  };
  using WorkedOff = std::function<void(bool any)>;
  struct Taker {
    bool is_lane = false;
    bool starting = false;
    WorkedOff done;
  };

  [[nodiscard]] const NodeCost& cost_of(std::uint32_t node) const {
    return model_.costs[model_.nodes[node].cost];
  }
  [[nodiscard]] bool is_tile(std::uint32_t node) const {
    return model_.nodes[node].children.empty();
  }
  [[nodiscard]] std::uint64_t weight_of(std::uint32_t node) const;
  [[nodiscard]] bool has_room(std::uint32_t node) const;
  void begin_lanes();
  void run_lane(bool starting);
  void lane_ended();
  void work_as_caller();
  void lend_hand(Then then);
  void work_off_one(Taker taker);
  void take_next();
  void take_tile(std::uint32_t node);
  void read_ahead();
  void give(std::uint32_t node);
  void work_off(std::uint32_t node, Then done);
  void load(std::uint32_t node, Then loaded);
  void triangulate(std::uint32_t node, Then done);
  void start_part(const std::shared_ptr<Work>& work, std::uint32_t part);
  void part_done(const std::shared_ptr<Work>& work, std::uint32_t part);
  void node_done(std::uint32_t node, Then done);

  const RunModel& model_;
  SimulatedMachine& machine_;
  TaskPlayer tasks_;
  BlockPlayer blocks_;
  std::vector<std::uint32_t> parent_;                    ///< by node
  std::vector<std::uint32_t> missing_;                   ///< children, likewise
  std::vector<std::vector<std::uint32_t>> part_parent_;  ///< by cost and part
  std::uint32_t added_ = 0;                              ///< nodes that may be worked on
  std::deque<std::uint32_t> ready_;
  std::uint64_t ready_points_ = 0;
  const std::size_t most_lanes_;
  std::size_t lanes_ = 0;
  std::size_t starting_ = 0;     ///< of these, who have not taken anything yet
  std::uint64_t under_way_ = 0;  ///< points of tiles
  Then all_done_{};
  Then idle_{};  ///< is told when the last lane ends
  bool taking_ = false;
  std::deque<Taker> takers_;  ///< that wait for their turn to take a node
  /// The tile that is read ahead, and who waits for it.
  std::uint32_t ahead_;
  bool ahead_read_ = false;
  bool ahead_wanted_ = false;
};

}  // namespace spillway::command

#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "stream/plan/run_trace.h"
#include "tools/simulate/run_model.h"

namespace spillway::command {

/// Makes a model of a run on one thread from what that tells while it goes on. Times are those of
/// the processor, so that what else the machine does counts little; work between two steps counts
/// for the later one.
class RunRecorder {
 public:
  /// To be made by the thread of the run: what it does from now on counts.
  RunRecorder();

  void limits(const RunLimits& limits) { model_.limits = limits; }
  /// Also called by the thread that reads the next tile.
  void step(const StageStep& step);
  void node(const TaskNode& node);

  /// Once the run has ended.
  RunModel take(const RunStatistics& statistics, std::uint64_t output_bytes);

 private:
  struct Read {
    double seconds = 0;
    std::uint64_t bytes = 0;
  };
  /// As in PartCost, until the task is known.
  struct Part {
    double work = 0;
    double wall = 0;  ///< of the work
    PartCost cost;
  };

  double gap(double processor_time);
  void batch_step(const StageStep& step, double seconds, double gap);
  void tile_step(const StageStep& step, double seconds, double gap);
  PartCost part_cost(std::size_t number, const Task& task);
  void add_parts(const Task& task, NodeCost& cost);

  const std::thread::id thread_ = std::this_thread::get_id();
  double last_;  ///< processor time at the end of the last step
  bool begun_ = false;
  bool fetched_ = false;  ///< the batch comes from the source
  BatchCost batch_;       ///< on its way
  NodeCost node_;         ///< likewise
  double divide_ = 0;     ///< of the tile
  double divide_wall_ = 0;
  std::vector<Part> parts_;  ///< likewise
  std::mutex reads_mutex_;
  std::deque<Read> reads_;  ///< of tiles that are not done; guarded by reads_mutex_
  double block_bytes_ = 0;
  RunModel model_;
};

}  // namespace spillway::command

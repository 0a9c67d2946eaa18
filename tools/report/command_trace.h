#pragma once

#include <optional>
#include <string>

#include "stream/plan/run_trace.h"
#include "tools/report/task_file.h"
#include "tools/simulate/run_recorder.h"

namespace spillway::command {

/// What the command takes of a run: for --tasks, for --simulate-cores, and for --stats.
class CommandTrace final : public RunTrace {
 public:
  /// `tasks_path` is that of --tasks, or empty; the recorder, if there is one, must outlive it.
  /// Throws Failure if the file cannot be made.
  CommandTrace(const std::string& tasks_path, std::optional<RunRecorder>* recorder)
      : recorder_(recorder) {
    if (!tasks_path.empty()) tasks_.emplace(tasks_path);
  }

  [[nodiscard]] bool takes_nodes() const override { return tasks_ || recorder_ != nullptr; }
  [[nodiscard]] bool takes_steps() const override { return recorder_ != nullptr; }

  void limits(const RunLimits& limits) override {
    if (recorder_ != nullptr) (*recorder_)->limits(limits);
  }
  void step(const StageStep& step) override { (*recorder_)->step(step); }
  void node(const TaskNode& node) override {
    if (tasks_) tasks_->write(node);
    if (recorder_ != nullptr) (*recorder_)->node(node);
  }
  void begin_again() override {
    if (tasks_) tasks_->begin_again();
    if (recorder_ != nullptr) recorder_->emplace();
  }
  void end(const RunSums& sums) override { sums_ = sums; }

  /// Once the run has ended: completes the file, and returns the sums.
  RunSums commit() {
    if (tasks_) tasks_->commit();
    return sums_;
  }

 private:
  std::optional<TaskFile> tasks_;
  std::optional<RunRecorder>* recorder_;
  RunSums sums_;
};

}  // namespace spillway::command

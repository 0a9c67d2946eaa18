#pragma once
// Keeps the nodes and sums that a run tells.

#include <utility>
#include <vector>

#include "stream/plan/run_trace.h"

namespace spillway::test {

class KeptTrace : public RunTrace {
 public:
  [[nodiscard]] bool takes_nodes() const override { return true; }
  void node(const TaskNode& node) override { nodes.push_back(node); }
  void begin_again() override {
    ++begun_again;
    nodes.clear();
  }
  void end(const RunSums& told) override { sums = told; }

  std::vector<TaskNode> nodes;
  int begun_again = 0;
  RunSums sums;
};

}  // namespace spillway::test

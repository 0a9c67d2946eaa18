#include "tools/simulate/task_player.h"

#include <utility>

namespace spillway::command {

void TaskPlayer::play(const FlatTask& task, Urgency urgency, SimulatedMachine::Then done) {
  if (task.nodes.size() <= 1) {  // most of them
    const FlatTask::Node own = task.nodes.empty() ? FlatTask::Node{} : task.nodes.front();
    return machine_.compute(own.seconds, own.grains, urgency, std::move(done));
  }
  const std::size_t root = begin(task, 0, urgency);
  states_[root].parent = root;
  states_[root].done = std::move(done);
  advance(root);
}

std::size_t TaskPlayer::begin(const FlatTask& task, std::uint32_t node, Urgency urgency) {
  if (unused_.empty()) {
    unused_.push_back(states_.size());
    states_.emplace_back();
  }
  const std::size_t number = unused_.back();
  unused_.pop_back();
  states_[number] = {.task = &task,
                     .node = node,
                     .next = node + 1,
                     .left = task.nodes[node].before,
                     .urgency = urgency};
  return number;
}

/// Begins the next of the nodes below.
void TaskPlayer::begin_below(std::size_t state) {
  const std::uint32_t below = states_[state].next;
  const FlatTask& task = *states_[state].task;
  states_[state].next = task.nodes[below].end;
  const std::size_t child = begin(task, below, states_[state].urgency);
  states_[child].parent = state;
  advance(child);
}

/// Starts whatever comes next in a node that waits for nothing. Others may begin meanwhile, so
/// nothing of a state is held.
void TaskPlayer::advance(std::size_t state) {
  const FlatTask::Node& node = states_[state].task->nodes[states_[state].node];
  if (states_[state].phase == Phase::kBefore) {
    states_[state].pending = 1;
    if (states_[state].left > 0) {
      --states_[state].left;
      return begin_below(state);
    }
    states_[state].phase = Phase::kOwn;
    return machine_.compute(node.seconds, node.grains, states_[state].urgency,
                            [this, state] { finish_one(state); });
  }
  if (states_[state].phase == Phase::kOwn) {
    states_[state].phase = Phase::kChildren;
    if (node.children > 0) {
      states_[state].pending = node.children;
      for (std::uint16_t c = 0; c < node.children; ++c) begin_below(state);
      return;
    }
  }
  if (states_[state].phase == Phase::kChildren) {
    states_[state].phase = Phase::kAfter;
    states_[state].left = node.after;
  }
  if (states_[state].left > 0) {
    --states_[state].left;
    states_[state].pending = 1;
    return begin_below(state);
  }
  const std::size_t parent = states_[state].parent;
  SimulatedMachine::Then done = std::move(states_[state].done);
  unused_.push_back(state);
  if (parent != state) {
    finish_one(parent);
  } else {
    done();
  }
}

/// One thing that this node waited for is done.
void TaskPlayer::finish_one(std::size_t state) {
  if (--states_[state].pending == 0) advance(state);
}

}  // namespace spillway::command

#include "tools/simulate/block_player.h"

#include <utility>

namespace spillway::command {

BlockPlayer::BlockPlayer(const RunModel& model, SimulatedMachine& machine)
    : model_(model), machine_(machine), submitted_(model.nodes.size()) {}

void BlockPlayer::submit(std::uint32_t node, std::uint32_t part) {
  submitted_[node].resize(parts_of(node).size());
  submitted_[node][part] = true;
  waiting_bytes_ += parts_of(node)[part].bytes;
  write_next();
}

void BlockPlayer::wait_for_room(std::uint32_t node, SimulatedMachine::Then then) {
  waiter_ = Waiter{node, std::move(then)};
  tell_waiter();
}

void BlockPlayer::write_next() {
  if (writing_ || next_node_ == model_.nodes.size()) return;
  if (submitted_[next_node_].empty() || !submitted_[next_node_][next_part_]) return;
  writing_ = true;
  const PartCost& block = parts_of(next_node_)[next_part_];
  machine_.move(block.bytes * model_.output_bytes, [this, &block] {
    machine_.compute(block.write, Urgency::kInOrder, [this] { written(); });
  });
}

void BlockPlayer::written() {
  writing_ = false;
  waiting_bytes_ -= parts_of(next_node_)[next_part_].bytes;
  if (++next_part_ == parts_of(next_node_).size()) {
    submitted_[next_node_] = {};
    ++next_node_;
    next_part_ = 0;
  }
  tell_waiter();
  write_next();
  tell_all_written();
}

void BlockPlayer::when_all_written(SimulatedMachine::Then then) {
  all_written_ = std::move(then);
  tell_all_written();
}

void BlockPlayer::tell_all_written() {
  if (all_written_ && next_node_ == model_.nodes.size()) std::exchange(all_written_, {})();
}

void BlockPlayer::tell_waiter() {
  if (!waiter_) return;
  const bool room = waiting_bytes_ <= static_cast<double>(model_.limits.waiting_bytes);
  if (!room && next_node_ < waiter_->node) return;
  const SimulatedMachine::Then then = std::exchange(waiter_, std::nullopt)->then;
  then();
}

}  // namespace spillway::command

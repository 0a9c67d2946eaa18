#include "tools/simulate/run_recorder.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "src/runtime/stage_times.h"

namespace spillway::command {
namespace {

bool is(const StageStep& step, Stage stage) {
  return step.stage == kStageNames[static_cast<std::size_t>(stage)];
}

void add(float& sum, double seconds) { sum += static_cast<float>(seconds); }

}  // namespace

RunRecorder::RunRecorder() : last_(processor_seconds()) {}

/// What the thread has done since the last step, but for a step that ends now.
double RunRecorder::gap(double processor_time) {
  const double now = processor_seconds();
  return std::max(0.0, now - processor_time - std::exchange(last_, now));
}

void RunRecorder::step(const StageStep& step) {
  if (is(step, Stage::kLoad) && step.in_order) {
    const std::lock_guard lock(reads_mutex_);
    reads_.push_back({step.processor_time, step.bytes});
    if (std::this_thread::get_id() != thread_) return;
  }
  double before = gap(step.processor_time);
  if (!std::exchange(begun_, true)) model_.begin = std::exchange(before, 0);
  if (is(step, Stage::kRead) || is(step, Stage::kDeal) || is(step, Stage::kSpill)) {
    batch_step(step, step.processor_time, before);
  } else {
    tile_step(step, step.processor_time, before);
  }
}

void RunRecorder::batch_step(const StageStep& step, double seconds, double gap) {
  auto& batches = model_.batches;
  if (is(step, Stage::kSpill)) {
    if (batches.empty()) return;
    add(step.in_order ? batches.back().write : batches.back().encode, seconds + gap);
    if (step.in_order) batches.back().written_bytes += static_cast<std::uint32_t>(step.bytes);
  } else if (is(step, Stage::kRead) && step.in_order) {
    fetched_ = true;
    batch_.fetched_bytes += static_cast<std::uint32_t>(step.bytes);
    add(batch_.fetch, seconds + gap);
  } else if (!step.in_order) {
    batch_.fetched_bytes += static_cast<std::uint32_t>(step.bytes);  // where it is decoded
    add(batch_.deal, seconds);
    // What is dealt again is fetched without being timed.
    add(fetched_ ? batch_.deal : batch_.fetch, gap);
  } else {
    add(batch_.append, seconds + gap);
    batches.push_back(std::exchange(batch_, {}));
    if (std::exchange(fetched_, false)) model_.read_batches = batches.size();
  }
}

void RunRecorder::tile_step(const StageStep& step, double seconds, double gap) {
  if (is(step, Stage::kLoad)) {
    add(node_.arrange, gap);
    if (step.in_order) return;
    add(node_.decode, seconds);
    ++node_.decode_grains;
  } else if (is(step, Stage::kDivide)) {
    add(node_.arrange, gap);
    divide_ += seconds;
    divide_wall_ += step.seconds;
  } else if (is(step, Stage::kLeaves) || is(step, Stage::kMerge)) {
    Part& part = parts_.emplace_back();
    part.work = seconds;
    part.wall = step.seconds;
    add(part.cost.settle, gap);
  } else if (!parts_.empty()) {
    PartCost& cost = parts_.back().cost;
    if (is(step, Stage::kWrite)) {
      add(cost.write, seconds);
      add(cost.settle, gap);
      cost.bytes += static_cast<std::uint32_t>(step.bytes);
    } else {
      add(cost.settle, seconds + gap);
    }
  }
}

/// The task tells what of its work can run at the same time; the step has its processor time.
PartCost RunRecorder::part_cost(std::size_t number, const Task& task) {
  if (number >= parts_.size()) return {.work = flatten(task, 1, false)};
  Part& part = parts_[number];
  PartCost cost = std::move(part.cost);
  block_bytes_ += cost.bytes;
  if (task.kind == TaskKind::kBaseCase) {
    cost.work = one_step(part.work);
    return cost;
  }
  const FlatTask wall = flatten(task, 1, false);
  const double known = wall.total_seconds();
  const double longest = std::max(part.wall, known);
  const double factor = longest > 0 ? part.work / longest : 1;
  cost.work = flatten(task, factor, false);
  add(cost.settle, part.work - factor * known);
  return cost;
}

void RunRecorder::add_parts(const Task& task, NodeCost& cost) {
  for (const Task& child : task.children) add_parts(child, cost);
  PartCost part = part_cost(cost.parts.size(), task);
  part.children = static_cast<std::uint32_t>(task.children.size());
  cost.parts.push_back(std::move(part));
}

void RunRecorder::node(const TaskNode& node) {
  NodeCost cost = std::exchange(node_, {});
  add(cost.finish, gap(0));
  if (node.children.empty()) {
    cost.points = node.task.points;
    if (cost.decode_grains > 1) --cost.decode_grains;  // it is counted from 1
    const std::lock_guard lock(reads_mutex_);
    if (!reads_.empty()) {
      cost.read = static_cast<float>(reads_.front().seconds);
      cost.read_bytes = reads_.front().bytes;
      reads_.pop_front();
    }
    Task tile = node.task;
    Task division;
    std::swap(division.before, tile.before);
    const double known = division.total_seconds();
    const double longest = std::max(divide_wall_, known);
    const double factor = longest > 0 ? divide_ / longest : 1;
    cost.divide = flatten(division, factor);
    add(cost.arrange, divide_ - factor * known);
    add_parts(tile, cost);
  } else {
    cost.parts.push_back(part_cost(0, node.task));
  }
  divide_ = divide_wall_ = 0;
  parts_.clear();
  if (model_.nodes.size() <= node.number) model_.nodes.resize(node.number + 1);
  model_.nodes[node.number] = {.cost = static_cast<std::uint32_t>(model_.costs.size()),
                               .children = node.children,
                               .after_batches = static_cast<std::uint32_t>(model_.batches.size())};
  model_.costs.push_back(std::move(cost));
}

RunModel RunRecorder::take(const RunStatistics& statistics, std::uint64_t output_bytes) {
  model_.end = gap(0);
  model_.points = statistics.mesh.points;
  if (block_bytes_ > 0) model_.output_bytes = static_cast<double>(output_bytes) / block_bytes_;
  return std::move(model_);
}

}  // namespace spillway::command

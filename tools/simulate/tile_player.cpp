#include "tools/simulate/tile_player.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace spillway::command {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// The parts above those of a node, by number.
std::vector<std::uint32_t> parents_of(const std::vector<PartCost>& parts) {
  std::vector<std::uint32_t> parents(parts.size(), kNone);
  std::vector<std::uint32_t> roots;
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    for (std::uint32_t c = 0; c < parts[p].children; ++c) {
      parents[roots.back()] = p;
      roots.pop_back();
    }
    roots.push_back(p);
  }
  return parents;
}

}  // namespace

TilePlayer::TilePlayer(const RunModel& model, SimulatedMachine& machine, unsigned threads)
    : model_(model),
      machine_(machine),
      tasks_(machine),
      blocks_(model, machine),
      parent_(model.nodes.size(), kNone),
      missing_(model.nodes.size()),
      most_lanes_(std::max(threads, 2U) - 1),
      ahead_(kNone) {
  for (std::uint32_t n = 0; n < model.nodes.size(); ++n) {
    missing_[n] = static_cast<std::uint32_t>(model.nodes[n].children.size());
    for (const std::uint32_t child : model.nodes[n].children) parent_[child] = n;
  }
  for (const NodeCost& cost : model.costs) part_parent_.push_back(parents_of(cost.parts));
}

void TilePlayer::add_until(std::uint32_t end) {
  for (; added_ < end; ++added_) {
    if (missing_[added_] > 0) continue;
    ready_.push_back(added_);
    ready_points_ += weight_of(added_);
  }
}

std::uint64_t TilePlayer::weight_of(std::uint32_t node) const {
  return std::min(cost_of(node).points, model_.limits.tile_points);
}

bool TilePlayer::has_room(std::uint32_t node) const {
  return under_way_ == 0 || weight_of(node) <= model_.limits.loaded_points - under_way_;
}

void TilePlayer::work_ahead(Then then) {
  begin_lanes();
  lend_hand(std::move(then));
}

void TilePlayer::lend_hand(Then then) {
  if (ready_.size() <= 1) return then();
  if (ready_.size() <= most_lanes_ && ready_points_ <= model_.limits.ready_points) return then();
  work_off_one({.done = [this, then = std::move(then)](bool any) {
    if (any) return lend_hand(then);
    when_idle([this, then] { lend_hand(then); });
  }});
}

void TilePlayer::when_idle(Then done) {
  if (lanes_ == 0) return done();
  idle_ = std::move(done);
}

void TilePlayer::work_off_all(Then done) {
  all_done_ = std::move(done);
  begin_lanes();
  work_as_caller();
}

void TilePlayer::work_as_caller() {
  work_off_one({.done = [this](bool any) {
    if (any) return work_as_caller();
    when_idle([this] { blocks_.when_all_written(all_done_); });
  }});
}

/// As many as there are threads and room for.
void TilePlayer::begin_lanes() {
  while (lanes_ < most_lanes_ && ready_.size() > starting_ && has_room(ready_.front())) {
    ++lanes_;
    ++starting_;
    run_lane(true);
  }
}

/// Until nothing is ready, or there is no room for it.
void TilePlayer::run_lane(bool starting) {
  work_off_one({.is_lane = true, .starting = starting, .done = [this](bool any) {
                  if (any) {
                    run_lane(false);
                  } else {
                    lane_ended();
                  }
                }});
}

void TilePlayer::lane_ended() {
  if (--lanes_ == 0 && idle_) std::exchange(idle_, {})();
}

/// Takes what is next and works it off, with the merges above that this was the last for.
void TilePlayer::work_off_one(Taker taker) {
  takers_.push_back(std::move(taker));
  // Not at once, so that lanes that find nothing do not pile up on the stack.
  machine_.compute(0, Urgency::kLoad, [this] { take_next(); });
}

void TilePlayer::take_next() {
  if (taking_ || takers_.empty()) return;
  if (std::exchange(takers_.front().starting, false)) --starting_;
  if (ready_.empty() || !has_room(ready_.front())) {
    const WorkedOff done = std::move(takers_.front().done);
    takers_.pop_front();
    done(false);
    return take_next();
  }
  taking_ = true;
  const std::uint32_t node = ready_.front();
  ready_.pop_front();
  ready_points_ -= weight_of(node);
  under_way_ += weight_of(node);
  if (!is_tile(node)) return give(node);
  blocks_.wait_for_room(node, [this, node] { take_tile(node); });
}

void TilePlayer::take_tile(std::uint32_t node) {
  if (ahead_ != node) {
    const NodeCost& cost = cost_of(node);
    return machine_.move(static_cast<double>(cost.read_bytes), [this, node, &cost] {
      machine_.compute(cost.read, Urgency::kLoad, [this, node] {
        read_ahead();
        give(node);
      });
    });
  }
  ahead_wanted_ = true;
  if (!ahead_read_) return;
  read_ahead();
  give(node);
}

/// Begins to read the next tile that is ready, if it is on the disk.
void TilePlayer::read_ahead() {
  ahead_ = kNone;
  ahead_read_ = ahead_wanted_ = false;
  const auto next = std::ranges::find_if(ready_, [this](std::uint32_t n) { return is_tile(n); });
  if (next == ready_.end() || cost_of(*next).read_bytes == 0) return;
  ahead_ = *next;
  const NodeCost& cost = cost_of(ahead_);
  machine_.move(static_cast<double>(cost.read_bytes), [this, &cost] {
    machine_.compute(cost.read, Urgency::kLoad, [this] {
      ahead_read_ = true;
      if (!ahead_wanted_) return;
      const std::uint32_t node = ahead_;
      read_ahead();
      give(node);
    });
  });
}

/// The node goes to who waits, and the next one may take another.
void TilePlayer::give(std::uint32_t node) {
  const Taker taker = std::move(takers_.front());
  takers_.pop_front();
  taking_ = false;
  if (taker.is_lane) begin_lanes();
  work_off(node, [done = taker.done] { done(true); });
  take_next();
}

void TilePlayer::work_off(std::uint32_t node, Then done) {
  const auto finished = [this, node, done = std::move(done)] {
    machine_.compute(cost_of(node).finish, Urgency::kMerge,
                     [this, node, done] { node_done(node, done); });
  };
  if (!is_tile(node)) return triangulate(node, finished);
  load(node, [this, node, finished] { triangulate(node, finished); });
}

void TilePlayer::load(std::uint32_t node, Then loaded) {
  const NodeCost& cost = cost_of(node);
  machine_.compute(cost.decode, cost.decode_grains, Urgency::kLoad,
                   [this, &cost, loaded = std::move(loaded)] {
                     machine_.compute(cost.arrange, Urgency::kLoad, [this, &cost, loaded] {
                       tasks_.play(cost.divide, Urgency::kLoad, loaded);
                     });
                   });
}

/// All parts of a node: those without children at once, in order.
void TilePlayer::triangulate(std::uint32_t node, Then done) {
  const std::vector<PartCost>& parts = cost_of(node).parts;
  const auto work = std::make_shared<Work>();
  work->node = node;
  work->done = std::move(done);
  for (const PartCost& part : parts) work->missing.push_back(part.children);
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    if (parts[p].children == 0) start_part(work, p);
  }
}

void TilePlayer::start_part(const std::shared_ptr<Work>& work, std::uint32_t part) {
  const PartCost& cost = cost_of(work->node).parts[part];
  const bool leaf = is_tile(work->node) && cost.children == 0;
  const Urgency merge = is_tile(work->node) ? Urgency::kMerge : Urgency::kTopMerge;
  const auto settled = [this, work, part] {
    blocks_.submit(work->node, part);
    part_done(work, part);
  };
  if (leaf && cost.work.nodes.size() == 1) {  // by one thread, with all that follows
    return machine_.compute(cost.work.nodes[0].seconds + cost.settle, Urgency::kLeaf, settled);
  }
  tasks_.play(cost.work, merge,
              [this, &cost, merge, settled] { machine_.compute(cost.settle, merge, settled); });
}

void TilePlayer::part_done(const std::shared_ptr<Work>& work, std::uint32_t part) {
  const std::uint32_t above = part_parent_[model_.nodes[work->node].cost][part];
  if (above == kNone) {
    work->done();
  } else if (--work->missing[above] == 0) {
    start_part(work, above);
  }
}

/// Other tiles may be loaded while merges follow.
void TilePlayer::node_done(std::uint32_t node, Then done) {
  under_way_ -= weight_of(node);
  begin_lanes();
  const std::uint32_t above = parent_[node];
  // A merge that is not there yet is ready when it is added.
  if (above == kNone || --missing_[above] > 0 || above >= added_) return done();
  work_off(above, std::move(done));
}

}  // namespace spillway::command

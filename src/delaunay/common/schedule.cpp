#include "src/delaunay/common/schedule.h"

#include <deque>
#include <functional>
#include <queue>
#include <utility>

namespace spillway::delaunay {
namespace {

/// Plays a tree of tasks on a number of cores, event by event.
class Simulation {
 public:
  explicit Simulation(unsigned cores) : idle_cores_(cores) {}

  double run(const Task& root) {
    states_.push_back({.task = &root});
    advance(0);
    for (;;) {
      while (idle_cores_ > 0 && !ready_.empty()) {
        const std::size_t state = ready_.top().state;
        ready_.pop();
        --idle_cores_;
        const Task& task = *states_[state].task;
        running_.emplace(now_ + task.seconds / static_cast<double>(task.grains), state);
      }
      if (running_.empty()) return now_;
      const auto [time, state] = running_.top();
      running_.pop();
      now_ = time;
      ++idle_cores_;
      finish_one(state);
    }
  }

 private:
  enum class Phase { kBefore, kOwn, kChildren, kAfter };

  struct State {
    const Task* task;
    std::size_t parent = 0;
    std::size_t depth = 0;
    Phase phase = Phase::kBefore;
    std::size_t next_step = 0;  ///< of `before` or `after`
    std::size_t pending = 0;    ///< grains or tasks that must finish before the next step
  };

  void start(const Task& task, std::size_t parent) {
    states_.push_back({.task = &task, .parent = parent, .depth = states_[parent].depth + 1});
    advance(states_.size() - 1);
  }

  /// One thing that this task waited for is done.
  void finish_one(std::size_t state) {
    if (--states_[state].pending == 0) advance(state);
  }

  /// Starts whatever comes next in a task that waits for nothing.
  void advance(std::size_t s) {
    const Task& task = *states_[s].task;
    if (states_[s].phase == Phase::kBefore) {
      if (start_step(s, task.before)) return;
      states_[s].phase = Phase::kOwn;
      states_[s].pending = task.grains;
      for (std::size_t p = 0; p < task.grains; ++p)
        ready_.push({states_[s].depth, ready_count_++, s});
      return;
    }
    if (states_[s].phase == Phase::kOwn) {
      states_[s].phase = Phase::kChildren;
      states_[s].next_step = 0;
      if (!task.children.empty()) {
        states_[s].pending = task.children.size();
        for (const Task& child : task.children) start(child, s);
        return;
      }
    }
    states_[s].phase = Phase::kAfter;
    if (start_step(s, task.after)) return;
    if (s != 0) finish_one(states_[s].parent);
  }

  bool start_step(std::size_t s, const std::vector<Task>& steps) {
    if (states_[s].next_step == steps.size()) return false;
    states_[s].pending = 1;
    start(steps[states_[s].next_step++], s);
    return true;
  }

  struct ReadyGrain {
    std::size_t depth;
    std::size_t order;  ///< in which it became ready
    std::size_t state;

    /// Whether the other comes first.
    bool operator<(const ReadyGrain& other) const {
      return depth != other.depth ? depth < other.depth : order > other.order;
    }
  };
  using Event = std::pair<double, std::size_t>;  ///< end of a running grain, its task

  unsigned idle_cores_;
  double now_ = 0;
  std::deque<State> states_;  ///< grows while references into it are held
  std::priority_queue<ReadyGrain> ready_;
  std::size_t ready_count_ = 0;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> running_;
};

}  // namespace

double greedy_makespan(const Task& root, unsigned cores) { return Simulation(cores).run(root); }

}  // namespace spillway::delaunay

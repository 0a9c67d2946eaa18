#include "src/runtime/work_lease.h"

#include <mutex>

namespace spillway::runtime {

/// All guarded by the mutex of the budget's work.
struct WorkLease::Held {
  MemoryBudget& budget;
  const char* purpose;
  std::uint64_t bytes = 0;
  bool grown = false;
  unsigned waiting = 0;  ///< threads that wait until they may grow it

  /// `others` is how many may be at work when there is nothing left to wait for.
  void take_when_there_is(std::uint64_t more, unsigned others, const WorkForecast* forecast,
                          std::unique_lock<std::mutex>& lock) {
    WorkUnderWay& work = budget.work();
    while (!work.refusal && !budget.try_take(more)) {
      if (work.running > others) {
        work.changed.wait(lock);
        continue;
      }
      try {
        budget.take(more, purpose, forecast);
        break;
      } catch (...) {
        work.refusal = std::current_exception();
        work.changed.notify_all();
      }
    }
    if (work.refusal) std::rethrow_exception(work.refusal);
    bytes += more;
  }
};

WorkLease::WorkLease() = default;

WorkLease::WorkLease(MemoryBudget& budget, std::uint64_t bytes, const char* purpose)
    : held_(std::make_unique<Held>(Held{.budget = budget, .purpose = purpose})) {
  WorkUnderWay& work = budget.work();
  std::unique_lock lock(work.mutex);
  held_->take_when_there_is(bytes, 0, nullptr, lock);
  ++work.running;
}

void WorkLease::extend(std::uint64_t bytes, const char* purpose) {
  WorkUnderWay& work = held_->budget.work();
  std::unique_lock lock(work.mutex);
  held_->purpose = purpose;
  --work.running;
  work.changed.notify_all();
  try {
    held_->take_when_there_is(bytes, 0, nullptr, lock);
  } catch (...) {
    ++work.running;  // until its end
    throw;
  }
  ++work.running;
}

WorkLease::WorkLease(WorkLease&& other) noexcept = default;

WorkLease& WorkLease::operator=(WorkLease&& other) noexcept {
  std::swap(held_, other.held_);
  return *this;
}

WorkLease::~WorkLease() {
  if (!held_) return;
  WorkUnderWay& work = held_->budget.work();
  const std::lock_guard lock(work.mutex);
  held_->budget.give_back(held_->bytes);
  --work.running;
  if (work.growing == held_.get()) work.growing = nullptr;
  work.changed.notify_all();
}

void WorkLease::grow(std::uint64_t bytes, const WorkForecast& forecast) {
  held_->budget.give_back_freed(bytes);
  WorkUnderWay& work = held_->budget.work();
  std::unique_lock lock(work.mutex);
  const auto may_grow = [&] {
    return work.refusal || work.growing == nullptr || work.growing == held_.get();
  };
  if (!may_grow()) {
    // Work is at rest as soon as one of its threads is.
    if (held_->waiting++ == 0) --work.running;
    work.changed.notify_all();
    work.changed.wait(lock, may_grow);
    if (--held_->waiting == 0) ++work.running;
  }
  work.growing = held_.get();
  held_->take_when_there_is(bytes, 1, &forecast, lock);
  held_->grown = true;
}

bool WorkLease::grown() const {
  if (!held_) return false;
  const std::lock_guard lock(held_->budget.work().mutex);
  return held_->grown;
}

}  // namespace spillway::runtime

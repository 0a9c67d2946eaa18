#include "src/parallel/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <tbb/task_scheduler_observer.h>
#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>

#include "src/parallel/thread_demand.h"

namespace spillway::parallel {
namespace {

// The thread sanitizer does not see how the library, which is not built with it, passes a task from
// one thread to another and waits for it; these tell it (each a release or an acquire of `place`).
#ifdef __SANITIZE_THREAD__
void tell_release(void* place) { __tsan_release(place); }
void tell_acquire(void* place) { __tsan_acquire(place); }
#else
void tell_release(void* /*place*/) {}
void tell_acquire(void* /*place*/) {}
#endif

/// Tells of a release at the end of a scope, also where that is an exception.
class ReleaseAtEnd {
 public:
  explicit ReleaseAtEnd(void* place) : place_(place) {}
  ~ReleaseAtEnd() { tell_release(place_); }
  ReleaseAtEnd(const ReleaseAtEnd&) = delete;
  ReleaseAtEnd& operator=(const ReleaseAtEnd&) = delete;

 private:
  void* place_;
};

/// The same of an acquire.
class AcquireAtEnd {
 public:
  explicit AcquireAtEnd(void* place) : place_(place) {}
  ~AcquireAtEnd() { tell_acquire(place_); }
  AcquireAtEnd(const AcquireAtEnd&) = delete;
  AcquireAtEnd& operator=(const AcquireAtEnd&) = delete;

 private:
  void* place_;
};

char handed_over;  // the place where all tasks change hands

/// One task as the library gets it: it moves it into memory of its own, which it uses again, and
/// runs and destroys it in any thread.
class HandedOver {
 public:
  HandedOver(std::function<void()> work, void* group)
      : work_(new std::function<void()>(std::move(work))), group_(group) {}
  HandedOver(HandedOver&& other) noexcept
      : work_((tell_acquire(&handed_over), std::exchange(other.work_, nullptr))),
        group_(other.group_) {
    tell_release(&handed_over);
  }
  HandedOver(const HandedOver&) = delete;
  HandedOver& operator=(const HandedOver&) = delete;
  ~HandedOver() {
    tell_acquire(&handed_over);
    delete work_;
    tell_release(&handed_over);
  }

  void operator()() const {
    tell_acquire(&handed_over);
    const ReleaseAtEnd release(group_);
    (*work_)();
  }

 private:
  std::function<void()>* work_;  // owned; nothing of it is touched after the destructor's last line
  void* group_;
};

/// Threads that start_threads() has made the library start, the caller's among them.
std::atomic<unsigned> started = 1;

/// Makes the library start this many threads now, one of which is the caller's. It would do so when
/// it first has work for them; and if that failed in the midst of other work, it might wait for
/// that forever.
void start_threads(unsigned threads) {
  constexpr std::chrono::seconds kLongestWait{1};  // the library may have its reasons to give fewer
  if (threads <= started) return;
  struct {
    std::mutex mutex;
    std::condition_variable changed;
    unsigned here = 1;   // guarded by mutex
    bool go_on = false;  // guarded by mutex
  } meeting;
  const auto arrive = [&meeting] {
    std::unique_lock lock(meeting.mutex);
    ++meeting.here;
    meeting.changed.notify_all();
    meeting.changed.wait(lock, [&] { return meeting.go_on; });
  };
  const auto let_go = [&meeting] {
    const std::lock_guard lock(meeting.mutex);
    meeting.go_on = true;
    meeting.changed.notify_all();
  };
  TaskGroup group;
  try {
    for (unsigned i = 1; i < threads; ++i) group.run(arrive);
  } catch (...) {
    let_go();
    throw;
  }
  {
    std::unique_lock lock(meeting.mutex);
    meeting.changed.wait_for(lock, kLongestWait, [&] { return meeting.here == threads; });
  }
  let_go();
  group.wait();
  started = threads;
}

/// Lets the library's threads that come to an arena work at the run of whom it is for.
class RunOfThreads : public tbb::task_scheduler_observer {
 public:
  RunOfThreads(tbb::task_arena& arena, RunMemory& memory)
      : task_scheduler_observer(arena), memory_(memory) {
    tell_release(this);
    observe(true);
  }
  ~RunOfThreads() override {
    observe(false);  // waits for calls that have begun
    tell_acquire(this);
  }

  void on_scheduler_entry(bool is_worker) override {
    tell_acquire(this);
    if (is_worker) work_with(&memory_);
    tell_release(this);
  }
  void on_scheduler_exit(bool is_worker) override {
    if (is_worker) work_with(nullptr);
    tell_release(this);
  }

 private:
  RunMemory& memory_;
};

bool single_threaded() { return tbb::this_task_arena::max_concurrency() == 1; }

}  // namespace

unsigned available_threads() { return static_cast<unsigned>(tbb::info::default_concurrency()); }

void with_threads(unsigned threads, const std::function<void()>& work) {
  const ThreadDemand demand(threads);
  tbb::task_arena arena(static_cast<int>(threads));
  // An observer that does this itself, and finds no memory, is left in a state that it cannot end.
  arena.initialize();
  const RunOfThreads run(arena, RunMemory::current());
  arena.execute([&] {
    start_threads(threads);
    work();
  });
}

void release_threads() {
  if (started > 1 && ThreadDemand::release()) started = 1;
}

/// Nobody but the group's own tasks can cancel these: if a task that made them were cancelled,
/// wait() would return though some were never run, and what they were to make would be missing.
struct TaskGroup::Tasks {
  tbb::task_group_context context{
      tbb::task_group_context::isolated,
      tbb::task_group_context::default_traits | tbb::task_group_context::concurrent_wait};
  tbb::task_group group{context};
};

TaskGroup::TaskGroup() : tasks_(std::make_unique<Tasks>()) {}

TaskGroup::~TaskGroup() {
  if (std::uncaught_exceptions() == 0) return;
  // It came before wait(), and is the one that counts.
  tasks_->group.cancel();
  try {
    wait();
  } catch (...) {
  }
}

void TaskGroup::run(std::function<void()> work) {
  if (single_threaded()) {
    work();
  } else {
    tasks_->group.run(HandedOver(std::move(work), this));
  }
}

void TaskGroup::wait() {
  const AcquireAtEnd acquire(this);
  tasks_->group.wait();
}

void isolated(const std::function<void()>& work) { tbb::this_task_arena::isolate(work); }

void parallel_for(
    std::size_t count, std::size_t grain,
    const std::function<void(std::size_t grain_number, std::size_t begin, std::size_t end)>& body) {
  const std::size_t grains = grain_count(count, grain);
  const auto run = [&](std::size_t g) { body(g, g * grain, std::min(count, (g + 1) * grain)); };
  if (grains <= 1 || single_threaded()) {
    for (std::size_t g = 0; g < grains; ++g) run(g);
    return;
  }
  std::atomic<std::size_t> next = 0;
  const auto take_turns = [&] {
    try {
      for (std::size_t g = next++; g < grains; g = next++) run(g);
    } catch (...) {
      next = grains;  // nobody need begin another grain
      throw;
    }
  };
  isolated([&] {
    TaskGroup group;
    const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    for (std::size_t i = 1; i < std::min(grains, threads); ++i) group.run(take_turns);
    take_turns();
    group.wait();
  });
}

void run_pipeline(std::size_t slots, const std::function<bool(std::size_t slot)>& source,
                  std::span<const PipelineStep> steps) {
  std::size_t next = 0;
  // The last step frees slots in the order in which they are taken.
  auto chain = tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                                   [&](tbb::flow_control& control) -> std::size_t {
                                                     tell_acquire(&handed_over);
                                                     const ReleaseAtEnd release(&handed_over);
                                                     const std::size_t slot = next++ % slots;
                                                     if (!source(slot)) control.stop();
                                                     return slot;
                                                   });
  for (const PipelineStep& step : steps) {
    chain =
        chain & tbb::make_filter<std::size_t, std::size_t>(
                    step.in_order ? tbb::filter_mode::serial_in_order : tbb::filter_mode::parallel,
                    [&](std::size_t slot) {
                      tell_acquire(&handed_over);
                      const ReleaseAtEnd release(&handed_over);
                      step.work(slot);
                      return slot;
                    });
  }
  const AcquireAtEnd acquire(&handed_over);
  tbb::task_group_context context(tbb::task_group_context::isolated);  // as a TaskGroup's
  tbb::parallel_pipeline(
      slots,
      chain & tbb::make_filter<std::size_t, void>(tbb::filter_mode::parallel, [](std::size_t) {}),
      context);
}

}  // namespace spillway::parallel

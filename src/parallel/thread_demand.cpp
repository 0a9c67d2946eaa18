#include "src/parallel/thread_demand.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <set>
#include <utility>

#include "src/parallel/parallel.h"

namespace spillway::parallel {
namespace {

constexpr auto kParallelism = tbb::global_control::max_allowed_parallelism;

/// All demands there are, and the limit that is set for them.
class Demands {
 public:
  void add(unsigned threads) {
    const std::lock_guard lock(mutex_);
    threads_.insert(threads);
    set_limit(lock);
  }

  bool release() {
    const std::lock_guard lock(mutex_);  // nobody begins meanwhile
    if (!threads_.empty()) return false;
    tbb::task_scheduler_handle scheduler{tbb::attach{}};
    return tbb::finalize(scheduler, std::nothrow);
  }

  void remove(unsigned threads) {
    const std::lock_guard lock(mutex_);
    threads_.erase(threads_.find(threads));
    set_limit(lock);
  }

 private:
  void set_limit(const std::lock_guard<std::mutex>&) {
    const unsigned highest =
        threads_.empty() ? 0 : std::max(*threads_.rbegin(), available_threads());
    if (highest == limit_) return;
    // The new one comes first: in between the lower of both counts, never the default.
    auto control = highest == 0 ? nullptr
                                : std::make_unique<tbb::global_control>(
                                      kParallelism, static_cast<std::size_t>(highest));
    std::swap(control_, control);
    limit_ = highest;
  }

  std::mutex mutex_;
  std::multiset<unsigned> threads_;               // guarded by mutex_
  unsigned limit_ = 0;                            // guarded by mutex_; 0: none is set
  std::unique_ptr<tbb::global_control> control_;  // guarded by mutex_
};

Demands& demands() {
  static Demands all;
  return all;
}

}  // namespace

ThreadDemand::ThreadDemand(unsigned threads) : threads_(threads) { demands().add(threads); }

ThreadDemand::~ThreadDemand() { demands().remove(threads_); }

bool ThreadDemand::release() { return demands().release(); }

unsigned ThreadDemand::limit() {
  return static_cast<unsigned>(tbb::global_control::active_value(kParallelism));
}

}  // namespace spillway::parallel

#pragma once
// The seam to the thread library (oneTBB): nothing else in the engine includes its headers. With
// one thread everything runs in the calling thread, in order.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "src/runtime/run_memory.h"

namespace spillway::parallel {

/// Number of processors this process may use.
unsigned available_threads();

/// Runs `work` with at most `threads` threads for all loops and groups inside. An exception of any
/// worker is thrown here. Calls from several threads run at the same time, each with its own
/// number.
void with_threads(unsigned threads, const std::function<void()>& work);

/// Ends the threads that with_threads() has started, unless some of them are at work, for whomever.
/// For whoever has come to an end with all its calls.
void release_threads();

/// Does `work` in a thread of its own, beside those of with_threads(): for what waits for a disk
/// most of the time. The future has what it returns or throws, and waits for it at its end.
template <typename Work>
auto in_background(Work work) {
  return std::async(std::launch::async, [&memory = RunMemory::current(), work = std::move(work)] {
    const WorksWithMemory works(memory);
    return work();
  });
}

/// Tasks that run at the same time. Inside with_threads(1, ...), run() does the work at once.
class TaskGroup {
 public:
  TaskGroup();
  ~TaskGroup();
  TaskGroup(const TaskGroup&) = delete;
  TaskGroup& operator=(const TaskGroup&) = delete;

  void run(std::function<void()> work);

  /// Waits for all tasks, lends a hand meanwhile, and throws what one of them threw. When it
  /// returns all have been run, whatever tasks elsewhere have thrown.
  void wait();

 private:
  struct Tasks;
  std::unique_ptr<Tasks> tasks_;
};

/// Runs `work` in the calling thread. While that waits for tasks of its own, the thread lends a
/// hand to those, but takes up nothing from outside: what it holds meanwhile may be just what a
/// task from outside would wait for.
void isolated(const std::function<void()>& work);

/// Number of grains that [0, count) falls into.
inline std::size_t grain_count(std::size_t count, std::size_t grain) {
  return (count + grain - 1) / grain;
}

/// Calls body(grain_number, begin, end) for consecutive ranges of `grain` items (the last may be
/// shorter) that cover [0, count). The ranges don't depend on the number of threads, so results
/// kept by grain number are deterministic. Grains are begun in ascending order. A single grain runs
/// in the calling thread. After an exception no further grain is begun.
void parallel_for(
    std::size_t count, std::size_t grain,
    const std::function<void(std::size_t grain_number, std::size_t begin, std::size_t end)>& body);

/// One step of a pipeline: does its work on the item in the slot of that number.
struct PipelineStep {
  bool in_order = false;  ///< one item at a time, in the order of the source; else many at once
  std::function<void(std::size_t slot)> work;
};

/// Sends items through steps that work at the same time on different items. `source` fills the
/// slot it is given and returns whether it could; it is called in order, as is the last step,
/// which must be in_order. At most `slots` items are under way, so slot numbers are below that.
void run_pipeline(std::size_t slots, const std::function<bool(std::size_t slot)>& source,
                  std::span<const PipelineStep> steps);

/// Works off a set of items that grows as it is worked on: calls body(items, found) for batches of
/// items, each thread pushing what it finds to its own `found`, until nothing is left. Batches keep
/// to about `batch` items; the order is unspecified.
template <typename Item, typename Body>
void parallel_work_queue(std::vector<Item> items, std::size_t batch, const Body& body) {
  std::function<void(std::vector<Item>)> work;  // outlives the tasks of `group`, which call it
  TaskGroup group;
  work = [&](std::vector<Item> todo) {
    std::vector<Item> found;
    while (!todo.empty()) {
      while (todo.size() > 2 * batch) {
        std::vector<Item> share(todo.end() - static_cast<std::ptrdiff_t>(batch), todo.end());
        todo.resize(todo.size() - batch);
        group.run([&work, share = std::move(share)] { work(share); });
      }
      found.clear();
      body(std::span<const Item>(todo), found);
      std::swap(todo, found);
    }
  };
  work(std::move(items));
  group.wait();
}

}  // namespace spillway::parallel

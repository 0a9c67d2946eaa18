#include "src/parallel/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

namespace spillway {
namespace {

bool single_threaded() { return tbb::this_task_arena::max_concurrency() == 1; }

}  // namespace

unsigned available_threads() { return static_cast<unsigned>(tbb::info::default_concurrency()); }

void with_threads(unsigned threads, const std::function<void()>& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  std::max(threads, available_threads()));
  tbb::task_arena arena(static_cast<int>(threads));
  arena.execute(work);
}

struct TaskGroup::Tasks {
  tbb::task_group group;
};

TaskGroup::TaskGroup() : tasks_(std::make_unique<Tasks>()) {}

TaskGroup::~TaskGroup() = default;

void TaskGroup::run(std::function<void()> work) {
  if (single_threaded()) {
    work();
  } else {
    tasks_->group.run(std::move(work));
  }
}

void TaskGroup::wait() { tasks_->group.wait(); }

void parallel_for(
    std::size_t count, std::size_t grain,
    const std::function<void(std::size_t grain_number, std::size_t begin, std::size_t end)>& body) {
  const std::size_t grains = grain_count(count, grain);
  const auto run = [&](std::size_t g) { body(g, g * grain, std::min(count, (g + 1) * grain)); };
  if (grains <= 1 || single_threaded()) {
    for (std::size_t g = 0; g < grains; ++g) run(g);
  } else {
    tbb::parallel_for(std::size_t{0}, grains, run);
  }
}

}  // namespace spillway

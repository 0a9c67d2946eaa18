#include "tools/simulate/machine.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace spillway::command {
namespace {

template <typename Item>
void push(std::vector<Item>& heap, Item item) {
  heap.push_back(std::move(item));
  std::push_heap(heap.begin(), heap.end());
}

template <typename Item>
Item pop(std::vector<Item>& heap) {
  std::pop_heap(heap.begin(), heap.end());
  Item item = std::move(heap.back());
  heap.pop_back();
  return item;
}

}  // namespace

void SimulatedMachine::compute(double seconds, Urgency urgency, Then then) {
  if (seconds <= 0) {
    at_once_.push_back(std::move(then));
  } else {
    push(ready_, Ready{urgency, order_++, seconds, std::move(then)});
  }
}

void SimulatedMachine::compute(double seconds, std::size_t grains, Urgency urgency, Then then) {
  if (grains <= 1 || seconds <= 0) return compute(seconds, urgency, std::move(then));
  const auto left = std::make_shared<std::pair<std::size_t, Then>>(grains, std::move(then));
  for (std::size_t g = 0; g < grains; ++g) {
    compute(seconds / static_cast<double>(grains), urgency, [left] {
      if (--left->first == 0) left->second();
    });
  }
}

void SimulatedMachine::move(double bytes, Then then) {
  if (bytes <= 0 || disk_speed_ <= 0) {
    at_once_.push_back(std::move(then));
    return;
  }
  disk_free_ = std::max(now_, disk_free_) + bytes / disk_speed_;
  at(disk_free_, false, std::move(then));
}

void SimulatedMachine::at(double time, bool frees_core, Then then) {
  push(events_, Event{time, order_++, frees_core, std::move(then)});
}

void SimulatedMachine::start_ready() {
  while (idle_ > 0 && !ready_.empty()) {
    Ready work = pop(ready_);
    --idle_;
    at(now_ + work.seconds, true, std::move(work.then));
  }
}

double SimulatedMachine::run() {
  for (;;) {
    while (!at_once_.empty()) {
      const Then then = std::move(at_once_.front());
      at_once_.pop_front();
      then();
    }
    start_ready();
    if (events_.empty()) return now_;
    const Event event = pop(events_);
    now_ = event.time;
    if (event.frees_core) ++idle_;
    event.then();
  }
}

}  // namespace spillway::command

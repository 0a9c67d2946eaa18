#pragma once

#include <cstdint>
#include <memory>

#include "src/runtime/memory_budget.h"

namespace spillway::runtime {

/// Memory that a piece of work with an end takes, such as a base case or a merge. Where a budget is
/// short of it, the work waits for other work that is under way, which gives its memory back at its
/// end: so fewer threads are at work. It fails only if nothing is left to wait for.
///
/// The thread that holds one must not begin unrelated work before it gives it back, not even while
/// it waits for tasks of its own (`isolated` in src/parallel/parallel.h): that might wait for it.
class WorkLease {
 public:
  WorkLease();
  /// Throws Failure (kOutOfBudget) with the purpose, as MemoryLease does.
  WorkLease(MemoryBudget& budget, std::uint64_t bytes, const char* purpose);
  WorkLease(WorkLease&& other) noexcept;
  WorkLease& operator=(WorkLease&& other) noexcept;
  ~WorkLease();

  /// Takes more, in the same way, once it is known how much that is. While it waits others do not
  /// wait for this work.
  void extend(std::uint64_t bytes, const char* purpose);

  /// Takes more than was thought. Of all work only one at a time does so, until its end: two that
  /// grow beside each other might each hold what the other one needs. Throws Failure (kOutOfBudget),
  /// which names a limit by what is forecast. For any thread of the work; not while it is moved.
  void grow(std::uint64_t bytes, const WorkForecast& forecast);

  /// Whether it has grown.
  [[nodiscard]] bool grown() const;

 private:
  struct Held;
  std::unique_ptr<Held> held_;
};

}  // namespace spillway::runtime

#pragma once
// One limit for the whole process. Whoever is about to hold much memory takes a lease first.

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <utility>

#include "src/runtime/freed_memory.h"
#include "src/runtime/work_forecast.h"

namespace spillway::runtime {

/// Bytes of memory that this machine has, or that its control group may use.
std::uint64_t machine_memory();

/// The smaller of 2 GiB and a quarter of the memory that this process may use: the machine's, or
/// its container's where that has less; of that an equal share if `processes` processes share it.
std::uint64_t default_memory_limit(unsigned processes = 1);

/// The number of bytes that "512M", "2G", "1.5g", "800MiB" or "1000000" stand for; K, M, G, T are
/// powers of 1024. Throws InvalidArgument for anything else.
std::uint64_t parse_memory_size(const std::string& text);

/// "512 MiB", "1.5 GiB": for messages.
std::string memory_size_text(std::uint64_t bytes);

/// The work that holds a WorkLease.
struct WorkUnderWay {
  std::mutex mutex;  ///< guards all others
  std::condition_variable changed;
  unsigned running = 0;           ///< leases that do not wait until they may grow
  std::exception_ptr refusal;     ///< once some was refused: of all the others, too
  const void* growing = nullptr;  ///< the one that has grown, until its end
};

/// Bytes promised to the stages of a run.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t limit) : MemoryBudget(limit, limit) {}
  /// A budget of `limit` bytes that is a part of the `whole` that the user gave: errors speak of
  /// the whole.
  MemoryBudget(std::uint64_t limit, std::uint64_t whole)
      : limit_(limit), whole_(whole), freed_(limit) {}

  [[nodiscard]] std::uint64_t limit() const { return limit_; }
  /// What the user gave, of which limit() is a part.
  [[nodiscard]] std::uint64_t whole() const { return whole_; }
  [[nodiscard]] std::uint64_t used() const { return used_; }

  /// Tells how much is enough for the run whatever it meets, for errors to name it.
  void set_enough(std::uint64_t bytes) { enough_ = bytes; }

  /// What is refused.
  struct Refusal {
    std::uint64_t used = 0;                  ///< bytes in use
    std::uint64_t bytes = 0;                 ///< that are asked for
    const WorkForecast* forecast = nullptr;  ///< of the work that asks, or none
  };

  /// Sets what a refusal asks how much will do as things look; 0 if it cannot tell. To be set while
  /// nobody takes anything.
  void set_estimate(std::function<std::uint64_t(const Refusal&)> estimate) {
    estimate_ = std::move(estimate);
  }

  /// For holders whose size changes; where it will do a MemoryLease is better. take() throws Failure
  /// as that does.
  void take(std::uint64_t bytes, const char* purpose, const WorkForecast* forecast = nullptr);
  /// The same, but returns whether there is that much.
  [[nodiscard]] bool try_take(std::uint64_t bytes);
  void give_back(std::uint64_t bytes) { used_ -= bytes; }

  /// For whoever is about to use much memory, leased or not: gives the system what has been freed,
  /// if the process has outgrown the limit by it, or would with so many bytes more.
  void give_back_freed(std::uint64_t wanted = 0) { freed_.give_back(wanted); }

  /// For WorkLease.
  [[nodiscard]] WorkUnderWay& work() { return work_; }

 private:
  const std::uint64_t limit_;
  const std::uint64_t whole_;
  std::atomic<std::uint64_t> enough_ = 0;
  std::function<std::uint64_t(const Refusal&)> estimate_;
  std::atomic<std::uint64_t> used_ = 0;
  FreedMemory freed_;
  WorkUnderWay work_;
};

/// A share of a budget that is given back in parts, by any thread.
class ShrinkingLease {
 public:
  explicit ShrinkingLease(MemoryBudget& budget) : budget_(budget) {}
  ~ShrinkingLease() { budget_.give_back(bytes_); }
  ShrinkingLease(const ShrinkingLease&) = delete;
  ShrinkingLease& operator=(const ShrinkingLease&) = delete;

  /// Throws Failure as MemoryLease does.
  void take(std::uint64_t bytes, const char* purpose) {
    budget_.take(bytes, purpose);
    bytes_ += bytes;
  }
  /// Gives back so many bytes, or all where that is less.
  void give_back(std::uint64_t bytes) {
    std::uint64_t before = bytes_;
    while (!bytes_.compare_exchange_weak(before, before - std::min(before, bytes))) {
    }
    budget_.give_back(std::min(before, bytes));
  }

 private:
  MemoryBudget& budget_;
  std::atomic<std::uint64_t> bytes_ = 0;
};

/// A share of a budget, held as long as the object lives.
class MemoryLease {
 public:
  MemoryLease() = default;
  /// Throws Failure (kOutOfBudget) if the budget has not that much left, with the purpose, a limit
  /// that may be enough and, where it is known, one that is.
  MemoryLease(MemoryBudget& budget, std::uint64_t bytes, const char* purpose)
      : budget_(&budget), bytes_(bytes) {
    budget.take(bytes, purpose);
  }
  MemoryLease(MemoryLease&& other) noexcept
      : budget_(std::exchange(other.budget_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
  MemoryLease& operator=(MemoryLease&& other) noexcept {
    std::swap(budget_, other.budget_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~MemoryLease() {
    if (budget_ != nullptr) budget_->give_back(bytes_);
  }
  MemoryLease(const MemoryLease&) = delete;
  MemoryLease& operator=(const MemoryLease&) = delete;

 private:
  MemoryBudget* budget_ = nullptr;
  std::uint64_t bytes_ = 0;
};

}  // namespace spillway::runtime

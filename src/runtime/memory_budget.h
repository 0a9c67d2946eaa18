#pragma once
// One limit for the whole process. Whoever is about to hold much memory takes a lease first.

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "src/runtime/freed_memory.h"

namespace spillway::detail {

/// The smaller of 2 GiB and a quarter of the memory that this process may use: the machine's, or
/// its container's where that has less; of that an equal share if `processes` processes share it.
std::uint64_t default_memory_limit(unsigned processes = 1);

/// The number of bytes that "512M", "2G", "1.5g", "800MiB" or "1000000" stand for; K, M, G, T are
/// powers of 1024. Throws InvalidArgument for anything else.
std::uint64_t parse_memory_size(const std::string& text);

/// "512 MiB", "1.5 GiB": for messages.
std::string memory_size_text(std::uint64_t bytes);

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

  /// Sets what a refusal asks how much will do as things look: a function of the bytes in use and
  /// of those that are refused; 0 if it cannot tell. To be set while nobody takes anything.
  void set_estimate(
      std::function<std::uint64_t(std::uint64_t used, std::uint64_t refused)> estimate) {
    estimate_ = std::move(estimate);
  }

  /// For holders whose size changes; where it will do a MemoryLease is better. take() throws Error
  /// as that does.
  void take(std::uint64_t bytes, const char* purpose);
  void give_back(std::uint64_t bytes) { used_ -= bytes; }

  /// For whoever is about to use much memory, leased or not: gives the system what has been freed,
  /// if the process has outgrown the limit by it, or would with so many bytes more.
  void give_back_freed(std::uint64_t wanted = 0) { freed_.give_back(wanted); }

 private:
  const std::uint64_t limit_;
  const std::uint64_t whole_;
  std::atomic<std::uint64_t> enough_ = 0;
  std::function<std::uint64_t(std::uint64_t, std::uint64_t)> estimate_;
  std::atomic<std::uint64_t> used_ = 0;
  FreedMemory freed_;
};

/// A share of a budget, held as long as the object lives.
class MemoryLease {
 public:
  MemoryLease() = default;
  /// Throws Error (kOutOfBudget) if the budget has not that much left, with the purpose, a limit
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

}  // namespace spillway::detail

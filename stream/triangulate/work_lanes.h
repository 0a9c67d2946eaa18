#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <utility>

#include "src/parallel/parallel.h"

namespace spillway::stream {

/// Works off what is ready, in the order in which it was added, on several *lanes* at a time: as
/// many as there are threads and room for. Each node has a weight; at most `room` of it is under
/// way, or one node. All inside of with_threads().
template <typename Node>
class WorkLanes {
 public:
  /// So much of the room may be ready, as many nodes as there are lanes, and one node at least,
  /// before the caller of work_beside() lends a hand.
  static constexpr std::uint64_t kReadyShare = 4;

  struct Work {
    std::function<std::uint64_t(const Node&)> weight;
    /// Of one node at a time, in order; and the one after it, or null if that is not ready.
    std::function<void(Node&, const Node* next)> begin;
    std::function<void(Node&)> finish;  ///< then; of many at a time. Its weight is free after it
    std::function<void(Node&)> follow;  ///< then: what was waiting for it alone
    std::function<void()> give_up;      ///< ends all waiting in the two, after a failure
    /// Whether work is to come to rest before this node is begun.
    std::function<bool(const Node& next)> rests = [](const Node&) { return false; };
    std::function<void()> at_rest = [] {};  ///< nothing is under way: work goes on after it
  };

  WorkLanes(unsigned threads, std::uint64_t room, Work work)
      : most_lanes_(std::max(threads, 2U) - 1), room_(room), work_(std::move(work)) {}

  void add(Node& node) {
    const std::lock_guard lock(mutex_);
    ready_.push_back(&node);
    ready_weight_ += work_.weight(node);
  }

  /// Works off what is ready while the caller goes on to bring more. If still more than a little is
  /// ready, the caller lends a hand first. Throws what a lane has thrown. The group is to be the
  /// same each time, and to be waited for.
  void work_beside(TaskGroup& group) {
    if (failed_) group.wait();
    group_ = &group;
    begin_lanes();
    while (much_ready() && !is_to_rest()) {
      if (!work_off_one(false)) group.wait();
    }
  }

  /// Ends what is under way of work_beside(), up to a node before which work is to rest.
  void come_to_rest(TaskGroup& group) {
    do {
      while (work_off_one(false)) {
      }
      group.wait();
    } while (has_ready() && !failed_ && !is_to_rest());
  }

  /// Works off all that is ready, and what is added meanwhile.
  void work_off() {
    TaskGroup group;
    group_ = &group;
    try {
      do {
        begin_lanes();
        come_to_rest(group);
        if (is_to_rest()) work_.at_rest();
      } while (has_ready() && !failed_);
    } catch (...) {
      give_up();
      throw;
    }
  }

  /// Nothing more is begun.
  void give_up() {
    failed_ = true;
    work_.give_up();
  }

 private:
  [[nodiscard]] bool much_ready() const {
    const std::lock_guard lock(mutex_);
    if (ready_.size() <= 1) return false;
    return ready_.size() > most_lanes_ || ready_weight_ > room_ / kReadyShare;
  }

  [[nodiscard]] bool has_ready() const {
    const std::lock_guard lock(mutex_);
    return !ready_.empty();
  }

  [[nodiscard]] bool is_to_rest() const {
    const std::lock_guard lock(mutex_);
    return !ready_.empty() && work_.rests(*ready_.front());
  }

  void begin_lanes() {
    while (may_begin_lane()) {
      group_->run([this] {
        {
          const std::lock_guard lock(mutex_);
          --starting_;
        }
        while (work_off_one(true)) {
        }
      });
    }
  }

  /// Who finds that a node is just being begun goes on: that may wait for what this thread has to
  /// do, and whoever begins it looks for lanes itself.
  bool may_begin_lane() {
    const std::unique_lock none_is_begun(begin_mutex_, std::try_to_lock);
    if (!none_is_begun) return false;
    const std::lock_guard lock(mutex_);
    if (failed_ || lanes_ >= most_lanes_ || ready_.size() <= starting_) return false;
    if (!has_room(*ready_.front()) || work_.rests(*ready_.front())) return false;
    ++lanes_;
    ++starting_;
    return true;
  }

  [[nodiscard]] bool has_room(const Node& node) const {
    const std::uint64_t used = under_way_;
    return used == 0 || used + work_.weight(node) <= room_;
  }

  /// False if nothing is ready, or there is no room for it, or after a failure: that ends a lane.
  bool work_off_one(bool is_lane) {
    try {
      Node* const node = take(is_lane);
      if (node == nullptr) return false;
      const std::uint64_t weight = work_.weight(*node);
      begin_lanes();
      // While a thread waits for a part of this, it does not take up another node: what it holds
      // may be just what that one would wait for.
      isolated([&] { work_.finish(*node); });
      under_way_ -= weight;
      begin_lanes();
      isolated([&] { work_.follow(*node); });
      return true;
    } catch (...) {
      give_up();
      throw;
    }
  }

  Node* take(bool is_lane) {
    const std::lock_guard none_is_begun(begin_mutex_);
    Node* node = nullptr;
    Node* next = nullptr;
    {
      const std::lock_guard lock(mutex_);
      if (failed_ || ready_.empty() || !has_room(*ready_.front()) || work_.rests(*ready_.front())) {
        if (is_lane) --lanes_;
        return nullptr;
      }
      node = ready_.front();
      ready_.pop_front();
      ready_weight_ -= work_.weight(*node);
      under_way_ += work_.weight(*node);
      if (!ready_.empty()) next = ready_.front();
    }
    work_.begin(*node, next);
    return node;
  }

  const unsigned most_lanes_;  ///< the caller is one more
  const std::uint64_t room_;
  const Work work_;
  TaskGroup* group_ = nullptr;
  std::atomic<std::uint64_t> under_way_ = 0;  ///< weight
  std::atomic<bool> failed_ = false;
  std::mutex begin_mutex_;    ///< held while a node is begun, which may wait; taken before mutex_
  mutable std::mutex mutex_;  ///< guards the next four
  std::deque<Node*> ready_;
  std::uint64_t ready_weight_ = 0;
  std::size_t starting_ = 0;  ///< lanes that have not taken anything yet
  unsigned lanes_ = 0;
};

}  // namespace spillway::stream

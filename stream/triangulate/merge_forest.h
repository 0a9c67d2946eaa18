#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <utility>
#include <vector>

#include "src/rooms.h"

namespace spillway::stream {

/// Trees that grow upwards while they are worked off, by many threads: whoever is done with the
/// last child of a node goes on with that node. Nodes are numbered in the order in which they are
/// added. Each has what a `State` has, which is for the caller.
template <typename State>
class MergeForest {
 public:
  struct Node : State {
    std::uint32_t number = 0;
    std::vector<Node*> children;

   private:
    friend class MergeForest;
    Node* parent_ = nullptr;
    std::size_t children_missing_ = 0;
    bool done_ = false;
  };

  struct Added {
    Node* node = nullptr;
    bool ready = false;  ///< it can be done at once: no child of it will lead to it
  };

  /// Adds a leaf, or a node above others that have no parent yet. By one thread at a time.
  Added add(State state, std::vector<Node*> children) {
    const std::lock_guard lock(mutex_);
    Node& node = nodes_.emplace_back();
    static_cast<State&>(node) = std::move(state);
    node.number = static_cast<std::uint32_t>(nodes_.size() - 1);
    for (Node* child : children) {
      child->parent_ = &node;
      if (!child->done_) ++node.children_missing_;
    }
    node.children = std::move(children);
    return {&node, node.children_missing_ == 0};
  }

  /// A node is done. Returns its parent if no other child of that is missing, else null.
  Node* done(Node& node) {
    const std::lock_guard lock(mutex_);
    node.done_ = true;
    return node.parent_ != nullptr && --node.parent_->children_missing_ == 0 ? node.parent_
                                                                             : nullptr;
  }

  [[nodiscard]] bool empty() const {
    const std::lock_guard lock(mutex_);
    return nodes_.empty();
  }

  /// Calls f(node) for those that are done, but not what is above them, in the order of their
  /// numbers. While none is being worked off.
  template <typename F>
  void visit_left_over(F&& f) {
    for (Node& node : nodes_) {
      if (node.done_ && (node.parent_ == nullptr || !node.parent_->done_)) f(node);
    }
  }

 private:
  mutable std::mutex mutex_;  ///< guards all that follows, and what is private of nodes
  std::deque<Node> nodes_;    ///< which stay where they are
};

}  // namespace spillway::stream

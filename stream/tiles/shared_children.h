#pragma once

#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "src/rooms.h"

namespace spillway::stream {

/// The children of a node. A copy shares them, so that a tree of which one part becomes another
/// takes memory for what is above that part only. Who changes a child changes it in all copies.
template <typename Node>
class SharedChildren {
 public:
  class Iterator {
   public:
    using value_type = Node;
    using difference_type = std::ptrdiff_t;

    Iterator() = default;
    explicit Iterator(const std::shared_ptr<Node>* at) : at_(at) {}
    const Node& operator*() const { return **at_; }
    const Node* operator->() const { return at_->get(); }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    Iterator operator++(int) { return Iterator(at_++); }
    bool operator==(const Iterator&) const = default;

   private:
    const std::shared_ptr<Node>* at_ = nullptr;
  };

  SharedChildren() = default;
  SharedChildren(std::initializer_list<Node> nodes) {
    for (const Node& node : nodes) push_back(node);
  }

  [[nodiscard]] Iterator begin() const { return Iterator(nodes_.data()); }
  [[nodiscard]] Iterator end() const { return Iterator(nodes_.data() + nodes_.size()); }
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  [[nodiscard]] const Node& operator[](std::size_t i) const { return *nodes_[i]; }
  [[nodiscard]] Node& operator[](std::size_t i) { return *nodes_[i]; }
  [[nodiscard]] const Node& back() const { return *nodes_.back(); }

  void push_back(Node node) { nodes_.push_back(std::make_shared<Node>(std::move(node))); }
  void push_back(std::shared_ptr<Node> node) { nodes_.push_back(std::move(node)); }
  Node& emplace_back() { return *nodes_.emplace_back(std::make_shared<Node>()); }

 private:
  std::vector<std::shared_ptr<Node>> nodes_;
};

}  // namespace spillway::stream

#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "src/delaunay/division/point_tree.h"

namespace spillway::stream {

/// A tree of points that is worked off from its leaves up, by many threads: whoever is done with
/// the last child of a node goes on with that node. Nodes are numbered in post-order. Each has what
/// a `State` has, which is for the caller.
template <PointTree Tree, typename State>
class MergeTree {
 public:
  struct Node : State {
    const Tree* tree = nullptr;
    std::uint32_t number = 0;
    Node* parent = nullptr;
    std::vector<Node*> children;

   private:
    friend class MergeTree;
    std::atomic<std::size_t> children_missing_ = 0;
  };

  /// `root` must outlive it.
  explicit MergeTree(const Tree& root)
      : count_(count(root)), nodes_(std::make_unique<Node[]>(count_)) {
    std::uint32_t next = 0;
    add(root, next);
  }

  /// In post-order.
  [[nodiscard]] std::span<Node> nodes() { return {nodes_.get(), count_}; }
  [[nodiscard]] Node& root() { return nodes_[count_ - 1]; }

  /// Those without children, in order.
  [[nodiscard]] const std::vector<Node*>& leaves() const { return leaves_; }

  /// To be called once a leaf is done: calls merge(node) for its parent if that has no other child
  /// that is not done, and so on upwards.
  template <typename Merge>
  void leaf_done(const Node& leaf, const Merge& merge) {
    for (Node* above = leaf.parent; above != nullptr && --above->children_missing_ == 0;
         above = above->parent) {
      merge(*above);
    }
  }

  /// The siblings of a node, of its parent, and so on: these and the node are the whole tree.
  [[nodiscard]] std::vector<const Tree*> siblings_up(const Node& node) const {
    std::vector<const Tree*> siblings;
    for (const Node* n = &node; n->parent != nullptr; n = n->parent) append_siblings(*n, siblings);
    return siblings;
  }

  /// The same, those of the node first, of each node upwards by itself.
  [[nodiscard]] std::vector<std::vector<const Tree*>> siblings_by_level(const Node& node) const {
    std::vector<std::vector<const Tree*>> levels;
    for (const Node* n = &node; n->parent != nullptr; n = n->parent) {
      append_siblings(*n, levels.emplace_back());
    }
    return levels;
  }

  /// Appends the other children of a node's parent.
  static void append_siblings(const Node& node, std::vector<const Tree*>& siblings) {
    if (node.parent == nullptr) return;
    for (const Node* sibling : node.parent->children) {
      if (sibling != &node) siblings.push_back(sibling->tree);
    }
  }

 private:
  static std::size_t count(const Tree& tree) {
    std::size_t nodes = 1;
    for (const Tree& child : tree.children) nodes += count(child);
    return nodes;
  }

  Node& add(const Tree& tree, std::uint32_t& next) {
    std::vector<Node*> children;
    for (const Tree& child : tree.children) children.push_back(&add(child, next));
    Node& node = nodes_[next];
    node.tree = &tree;
    node.number = next++;
    node.children_missing_ = children.size();
    for (Node* child : children) child->parent = &node;
    if (tree.leaf()) leaves_.push_back(&node);
    node.children = std::move(children);
    return node;
  }

  std::size_t count_;
  std::unique_ptr<Node[]> nodes_;
  std::vector<Node*> leaves_;
};

}  // namespace spillway::stream

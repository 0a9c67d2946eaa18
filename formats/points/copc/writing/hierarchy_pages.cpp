#include "formats/points/copc/writing/hierarchy_pages.h"

#include <algorithm>
#include <span>

namespace spillway::formats {
namespace {

constexpr std::int32_t kLevelsOfPage = 4;

/// Nodes in the order of their keys, and the pages that they make.
class Pages {
 public:
  explicit Pages(std::vector<HierarchyEntry> nodes) : nodes_(std::move(nodes)) {
    std::ranges::sort(nodes_, {}, &HierarchyEntry::key);
  }

  HierarchyPages put(std::uint64_t begin) && {
    pages_ = {{.top = NodeKey{}}};
    for (std::size_t p = 0; p < pages_.size(); ++p) {
      const NodeKey top = pages_[p].top;
      gather(p, *find(top), top.level + kLevelsOfPage);
    }
    std::uint64_t end = begin;
    for (Page& page : pages_) {
      page.begin = end;
      end += page.entries.size() * HierarchyEntry::kSize;
    }
    HierarchyPages all{.bytes = std::vector<std::byte>(end - begin),
                       .root_size = pages_[0].entries.size() * HierarchyEntry::kSize};
    for (const Page& page : pages_) {
      std::byte* at = &all.bytes[page.begin - begin];
      for (HierarchyEntry entry : page.entries) {
        if (entry.count == HierarchyEntry::kInOtherPage) {
          const Page& other = pages_[entry.offset];
          entry.offset = other.begin;
          entry.bytes = static_cast<std::int32_t>(other.entries.size() * HierarchyEntry::kSize);
        }
        store_entry(at, entry);
        at += HierarchyEntry::kSize;
      }
    }
    return all;
  }

 private:
  struct Page {
    NodeKey top;
    std::vector<HierarchyEntry> entries{};  // offsets of those in other pages: numbers of these
    std::uint64_t begin = 0;
  };

  [[nodiscard]] const HierarchyEntry* find(const NodeKey& key) const {
    const auto found = std::ranges::lower_bound(nodes_, key, {}, &HierarchyEntry::key);
    return found != nodes_.end() && found->key == key ? &*found : nullptr;
  }

  [[nodiscard]] std::vector<const HierarchyEntry*> children(const NodeKey& key) const {
    std::vector<const HierarchyEntry*> all;
    for (std::int32_t octant = 0; octant < 8; ++octant) {
      const NodeKey child{key.level + 1,
                          {2 * key.cell[0] + (octant & 1), 2 * key.cell[1] + (octant >> 1 & 1),
                           2 * key.cell[2] + (octant >> 2 & 1)}};
      if (const HierarchyEntry* const node = find(child)) all.push_back(node);
    }
    return all;
  }

  /// Puts a node and those below it into a page, but those below level `last` into others.
  void gather(std::size_t page, const HierarchyEntry& node, std::int32_t last) {
    const std::vector<const HierarchyEntry*> below = children(node.key);
    if (node.key.level == last && !below.empty()) {
      pages_[page].entries.push_back(
          {.key = node.key, .offset = pages_.size(), .count = HierarchyEntry::kInOtherPage});
      pages_.push_back({.top = node.key});
      return;
    }
    pages_[page].entries.push_back(node);
    for (const HierarchyEntry* const child : below) gather(page, *child, last);
  }

  std::vector<HierarchyEntry> nodes_;
  std::vector<Page> pages_;
};

}  // namespace

HierarchyPages hierarchy_pages(std::vector<HierarchyEntry> nodes, std::uint64_t begin,
                               std::size_t most_together) {
  if (nodes.empty()) nodes.push_back({.key = NodeKey{}});  // the root has no points
  if (nodes.size() > most_together) return Pages(std::move(nodes)).put(begin);
  std::ranges::sort(nodes, {}, &HierarchyEntry::key);
  HierarchyPages one{.bytes = std::vector<std::byte>(nodes.size() * HierarchyEntry::kSize),
                     .root_size = nodes.size() * HierarchyEntry::kSize};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    store_entry(&one.bytes[i * HierarchyEntry::kSize], nodes[i]);
  }
  return one;
}

}  // namespace spillway::formats

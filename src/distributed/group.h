#pragma once

#include <utility>

#include "src/distributed/items.h"
#include "src/distributed/ranks.h"

namespace spillway::distributed {

/// Ranks that follow each other, and the number of the first of them in names of vertices.
struct Group {
  const Ranks& ranks;
  int first = 0;

  [[nodiscard]] int end() const { return first + ranks.size(); }
  /// The number of this rank in names.
  [[nodiscard]] int own() const { return first + ranks.rank(); }
};

/// exchange_items() within a group, of items by the ranks' numbers in names.
template <typename T>
ItemsByRank<T> exchange_within(const Group& group, ItemsByRank<T> items, const ItemLimits& limits) {
  ItemsByRank<T> shifted;
  for (auto& [rank, some] : items) shifted[rank - group.first] = std::move(some);
  ItemsByRank<T> received;
  for (auto& [rank, some] : exchange_items(group.ranks, std::move(shifted), limits)) {
    received[rank + group.first] = std::move(some);
  }
  return received;
}

}  // namespace spillway::distributed

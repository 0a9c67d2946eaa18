#pragma once
// Lists of plain values as messages between ranks.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "src/distributed/ranks.h"
#include "src/runtime/memory_budget.h"

namespace spillway::distributed {

template <typename T>
using ItemsByRank = std::map<int, std::vector<T>>;

template <typename T>
std::vector<T> items_of(std::span<const std::byte> bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> items(bytes.size() / sizeof(T));
  if (!items.empty()) std::memcpy(items.data(), bytes.data(), items.size() * sizeof(T));
  return items;
}

/// How items go from rank to rank.
struct ItemLimits {
  std::size_t largest_message = std::size_t{16} << 20U;  ///< bytes; the same at all ranks
  ShrinkingLease* received = nullptr;                    ///< takes what comes, if there is one
};

/// Sends each rank its items, in as many rounds as it takes for no message to be larger than it
/// may, or one item; returns what this rank was sent, by the rank that sent it, in order.
/// Collective.
template <typename T>
ItemsByRank<T> exchange_items(const Ranks& ranks, ItemsByRank<T> items, const ItemLimits& limits) {
  const std::size_t at_once = std::max<std::size_t>(1, limits.largest_message / sizeof(T));
  std::uint64_t rounds = 0;
  ItemsByRank<T> received;
  if (const auto own = items.find(ranks.rank()); own != items.end()) {
    received[ranks.rank()] = std::move(own->second);
    items.erase(own);
  }
  for (const auto& [rank, some] : items) {
    rounds = std::max<std::uint64_t>(rounds, (some.size() + at_once - 1) / at_once);
  }
  ranks.reduce(std::span(&rounds, 1), Reduction::kMost);
  for (std::uint64_t round = 0; round < rounds; ++round) {
    std::vector<Message> messages;
    for (auto& [rank, some] : items) {
      const std::size_t begin = std::min(some.size(), round * at_once);
      const auto bytes =
          std::as_bytes(std::span(some).subspan(begin, std::min(at_once, some.size() - begin)));
      if (!bytes.empty()) messages.push_back({rank, {bytes.begin(), bytes.end()}});
      if (begin + at_once >= some.size()) some = {};
    }
    for (const Message& message : ranks.exchange(std::move(messages))) {
      if (limits.received != nullptr) {
        limits.received->take(message.bytes.size(), "the border between ranks");
      }
      const std::vector<T> some = items_of<T>(message.bytes);
      std::vector<T>& all = received[message.rank];
      all.insert(all.end(), some.begin(), some.end());
    }
  }
  return received;
}

/// The item of each rank, at all ranks. Collective.
template <typename T>
std::vector<T> gather_item(const Ranks& ranks, const T& item) {
  std::vector<T> items;
  for (const auto& bytes : ranks.gather(std::as_bytes(std::span(&item, 1)))) {
    items.push_back(items_of<T>(bytes).front());
  }
  return items;
}

}  // namespace spillway::distributed

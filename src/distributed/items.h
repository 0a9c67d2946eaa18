#pragma once
// Lists of plain values as messages between ranks.

#include <cstring>
#include <map>
#include <span>
#include <type_traits>
#include <vector>

#include "src/distributed/ranks.h"

namespace spillway::detail::distributed {

template <typename T>
using ItemsByRank = std::map<int, std::vector<T>>;

template <typename T>
std::vector<T> items_of(std::span<const std::byte> bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> items(bytes.size() / sizeof(T));
  if (!items.empty()) std::memcpy(items.data(), bytes.data(), items.size() * sizeof(T));
  return items;
}

/// Sends each rank its items; returns what this rank was sent, by the rank that sent it.
/// Collective.
template <typename T>
ItemsByRank<T> exchange_items(const Ranks& ranks, const ItemsByRank<T>& items) {
  std::vector<Message> messages;
  for (const auto& [rank, some] : items) {
    const auto bytes = std::as_bytes(std::span(some));
    messages.push_back({rank, {bytes.begin(), bytes.end()}});
  }
  ItemsByRank<T> received;
  for (const Message& message : ranks.exchange(std::move(messages))) {
    received[message.rank] = items_of<T>(message.bytes);
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

}  // namespace spillway::detail::distributed

#pragma once

#include <spillway/detail/probing_table.h>
#include <spillway/mesh.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

namespace spillway {

/// The vertices of a mesh that have come and may still be used, each with a value: what a sink
/// needs to hold of a mesh of any size, as few as lie along the border. Not safe for several
/// threads.
///
///   live.begin(block, block.vertices);
///   for (const std::uint64_t corner : block.corners) use(live.at(corner));
///   live.end(block);
template <typename Value>
class LiveVertices {
 public:
  /// Enters the vertices that come with a block. Shape of `values`: as block.vertices.
  void begin(const MeshBlock& block, std::span<const Value> values) {
    for (std::size_t v = 0; v < values.size(); ++v) enter(block.first_vertex + v, values[v]);
  }
  /// Forgets the vertices that come no more after it.
  void end(const MeshBlock& block) {
    for (const std::uint64_t vertex : block.finalized) forget(vertex);
  }

  /// The value of a vertex. Throws std::out_of_range if it has not come or comes no more, which no
  /// mesh has among its corners. Valid until the next change.
  [[nodiscard]] const Value& at(std::uint64_t vertex) const {
    if (const Value* const value = find(vertex)) return *value;
    throw std::out_of_range("vertex " + std::to_string(vertex) + " is not live");
  }
  /// Likewise; null instead.
  [[nodiscard]] const Value* find(std::uint64_t vertex) const {
    const Entry* const entry = table_.find(Entry{vertex, {}});
    return entry == nullptr ? nullptr : &entry->value;
  }
  [[nodiscard]] Value* find(std::uint64_t vertex) {
    Entry* const entry = table_.find(Entry{vertex, {}});
    return entry == nullptr ? nullptr : &entry->value;
  }
  [[nodiscard]] bool contains(std::uint64_t vertex) const { return find(vertex) != nullptr; }

  /// How many there are.
  [[nodiscard]] std::size_t size() const { return table_.size(); }

  /// A vertex that is not there yet is, or is not there any more (false: it was not there).
  void enter(std::uint64_t vertex, const Value& value) { table_.insert({vertex, value}); }
  bool forget(std::uint64_t vertex) {
    Entry* const entry = table_.find(Entry{vertex, {}});
    if (entry == nullptr) return false;
    table_.erase(entry);
    return true;
  }

  /// Calls f(vertex, value) for each, in no particular order.
  template <typename F>
  void for_each(const F& f) const {
    table_.for_each([&f](const Entry& entry) { f(entry.number, entry.value); });
  }

 private:
  struct Entry {
    static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
    std::uint64_t number = kEmpty;
    Value value{};

    [[nodiscard]] bool empty() const { return number == kEmpty; }
    [[nodiscard]] std::uint64_t scattered() const { return detail::scatter(number); }
    [[nodiscard]] bool same_key(const Entry& other) const { return number == other.number; }
  };

  detail::ProbingTable<Entry> table_;
};

}  // namespace spillway

#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/probing_table.h"

namespace spillway::detail {

/// The vertices of a mesh stream that are announced and may still be used, each with a value: as
/// few as the border, as those that come and go within one block are never entered.
template <typename Value>
class LiveVertices {
 public:
  /// Number of vertices that have come so far: the stream number of the next block's first one.
  [[nodiscard]] std::uint64_t announced() const { return announced_; }

  /// Number of vertices that may still be used.
  [[nodiscard]] std::size_t size() const { return table_.size(); }
  [[nodiscard]] bool contains(std::uint64_t number) const { return find(number) != nullptr; }

  /// The value of a vertex; null if it has not come or comes no more. Valid until the next change.
  [[nodiscard]] const Value* find(std::uint64_t number) const {
    const Entry* const entry = table_.find(Entry{number, {}});
    return entry == nullptr ? nullptr : &entry->value;
  }
  [[nodiscard]] Value* find(std::uint64_t number) {
    Entry* const entry = table_.find(Entry{number, {}});
    return entry == nullptr ? nullptr : &entry->value;
  }

  /// Appends the values of the vertices that a block imports to those of the vertices it announces,
  /// so that `values` is by short number. Throws std::out_of_range if one is not live, which
  /// streams from a reader or from the engine never have.
  void append_imported(const MeshBlock& block, std::vector<Value>& values) const {
    for (const std::uint64_t number : block.imported) {
      const Value* const value = find(number);
      if (value == nullptr) {
        throw std::out_of_range("a block imports vertex " + std::to_string(number) +
                                ", which is not live");
      }
      values.push_back(*value);
    }
  }

  /// Ends a block: forgets the vertices that it finalizes and enters those that it announces and
  /// does not finalize. `value_of(v)` is the value of the one with short number v.
  template <std::invocable<std::uint32_t> ValueOf>
  void settle(const MeshBlock& block, const ValueOf& value_of) {
    const std::size_t fresh = block.vertices.size();
    finalized_.assign(fresh, false);
    for (const std::uint32_t v : block.finalized) {
      if (v < fresh) {
        finalized_[v] = true;
      } else {
        forget(block.imported[v - fresh]);
      }
    }
    for (std::uint32_t v = 0; v < fresh; ++v) {
      if (!finalized_[v]) enter(announced_ + v, value_of(v));
    }
    announce(fresh);
  }
  void settle(const MeshBlock& block, std::span<const Value> values) {
    settle(block, [values](std::uint32_t v) { return values[v]; });
  }

  /// The steps of settle(), for blocks of another form: a vertex that is not there yet is, is not
  /// there any more (false: it was not there), and so many vertices have come.
  void enter(std::uint64_t number, const Value& value) { table_.insert({number, value}); }
  bool forget(std::uint64_t number) {
    Entry* const entry = table_.find(Entry{number, {}});
    if (entry == nullptr) return false;
    table_.erase(entry);
    return true;
  }
  void announce(std::uint64_t count) { announced_ += count; }

  /// Calls f(number, value) for each, in no particular order.
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
    [[nodiscard]] std::uint64_t scattered() const { return scatter(number); }
    [[nodiscard]] bool same_key(const Entry& other) const { return number == other.number; }
  };

  ProbingTable<Entry> table_;
  std::uint64_t announced_ = 0;
  std::vector<bool> finalized_;  ///< of the block that is settled, by short number
};

}  // namespace spillway::detail

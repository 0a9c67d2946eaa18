#pragma once

#include <spillway/live_vertices.h>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"

namespace spillway::formats {

/// The vertices of a mesh stream that are announced and may still be used, each with a value: as
/// few as the border, as those that come and go within one block are never entered.
template <typename Value>
class StreamVertices : public LiveVertices<Value> {
 public:
  /// Number of vertices that have come so far: the stream number of the next block's first one.
  [[nodiscard]] std::uint64_t announced() const { return announced_; }

  /// Appends the values of the vertices that a block imports to those of the vertices it announces,
  /// so that `values` is by short number. Throws std::out_of_range if one is not live, which
  /// streams from a reader or from the engine never have.
  void append_imported(const MeshStreamBlock& block, std::vector<Value>& values) const {
    for (const std::uint64_t number : block.imported) values.push_back(this->at(number));
  }

  /// Ends a block: forgets the vertices that it finalizes and enters those that it announces and
  /// does not finalize. `value_of(v)` is the value of the one with short number v.
  template <std::invocable<std::uint32_t> ValueOf>
  void settle(const MeshStreamBlock& block, const ValueOf& value_of) {
    const std::size_t fresh = block.vertices.size();
    finalized_.assign(fresh, false);
    for (const std::uint32_t v : block.finalized) {
      if (v < fresh) {
        finalized_[v] = true;
      } else {
        this->forget(block.imported[v - fresh]);
      }
    }
    for (std::uint32_t v = 0; v < fresh; ++v) {
      if (!finalized_[v]) this->enter(announced_ + v, value_of(v));
    }
    announce(fresh);
  }
  void settle(const MeshStreamBlock& block, std::span<const Value> values) {
    settle(block, [values](std::uint32_t v) { return values[v]; });
  }

  /// For blocks of another form: so many vertices have come.
  void announce(std::uint64_t count) { announced_ += count; }

  /// Of a new one, if it is read.
  template <typename State>
  void state(State& state) {
    std::vector<std::uint64_t> numbers;
    std::vector<Value> values;
    this->for_each([&](std::uint64_t number, const Value& value) {
      numbers.push_back(number);
      values.push_back(value);
    });
    state(announced_, numbers, values);
    if constexpr (State::kReads) {
      for (std::size_t v = 0; v < numbers.size(); ++v) this->enter(numbers[v], values[v]);
    }
  }

 private:
  std::uint64_t announced_ = 0;
  std::vector<bool> finalized_;  ///< of the block that is settled, by short number
};

}  // namespace spillway::formats

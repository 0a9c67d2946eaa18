#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/stream_vertices.h"
#include "stream/sinks/mesh_shares.h"

namespace spillway::stream {

/// What write() needs of a block of which those simplices are done that have no imported vertex:
/// the others, in the block, and their vertices and those that come again.
class RestOfBlock final : public AbsorbedBlock {
 public:
  /// Leaves the rest in `block`, by short numbers of what is left, and returns the corners of the
  /// simplices that are not: `corners` a simplex, by the short numbers of before.
  static std::vector<std::uint32_t> divide(MeshStreamBlock& block, std::size_t corners);

  [[nodiscard]] std::uint64_t bytes() const override { return places_.size() * sizeof(places_[0]); }
  /// How many vertices the block announced.
  [[nodiscard]] std::uint32_t announced() const { return announced_; }
  /// The short number of before of a vertex that is left.
  [[nodiscard]] std::uint32_t place(std::size_t vertex) const { return places_[vertex]; }

 private:
  std::uint32_t announced_ = 0;
  std::vector<std::uint32_t> places_;
};

/// Takes a mesh simplex by simplex, in any order, each with what its corners are to whoever takes
/// them: those whose vertices come in the same block when the block is absorbed, by many threads at
/// once, the others when it is written. Of the mesh only vertices that are still to come again stay
/// in memory.
template <typename Value>
class SimplexSink : public BlockSink {
 public:
  explicit SimplexSink(int dimension) : corners_(static_cast<std::size_t>(dimension) + 1) {}

  void absorb(MeshStreamBlock& block) final {
    const std::vector<Value> values = values_with(block.vertices, block.attributes);
    const std::vector<std::uint32_t> corners = RestOfBlock::divide(block, corners_);
    take_vertices(values);
    take_simplices(values, corners);
  }

  void write(MeshStreamBlock&& block) final {
    if (!block.absorbed) absorb(block);
    const auto& rest = static_cast<const RestOfBlock&>(*block.absorbed);
    std::vector<Value> values = values_with(block.vertices, block.attributes);
    std::vector<std::uint64_t> numbers(values.size());
    for (std::size_t v = 0; v < values.size(); ++v) {
      numbers[v] = live_.announced() + rest.place(v);
      live_.enter(numbers[v], values[v]);
    }
    numbers.insert(numbers.end(), block.imported.begin(), block.imported.end());
    live_.append_imported(block, values);
    take_simplices(values, block.corners);
    for (const std::uint32_t v : block.finalized) live_.forget(numbers[v]);
    live_.announce(rest.announced());
  }

  void finish(const MeshTotals& /*totals*/) override {}

  /// A block of its own, which changes nothing for those of the stream.
  void take_merged(const MergedBlock& block) {
    std::vector<Value> values = values_of(block.mesh.vertices);
    take_vertices(values);
    const std::vector<Value> imported = values_of(block.imported_vertices);
    values.insert(values.end(), imported.begin(), imported.end());
    take_simplices(values, block.mesh.corners);
  }

 protected:
  /// Of a new one, if it is read.
  template <typename State>
  void state(State& state) {
    state(live_);
  }

 private:
  /// What vertices, as they come, are. By many threads at once, as what follows.
  [[nodiscard]] virtual std::vector<Value> values_of(
      std::span<const LatticePoint> vertices) const = 0;
  /// Likewise of vertices with their attributes: a record each, or none if nobody wants them.
  [[nodiscard]] virtual std::vector<Value> values_with(
      std::span<const LatticePoint> vertices, std::span<const std::byte> /*attributes*/) const {
    return values_of(vertices);
  }
  /// Each vertex comes once.
  virtual void take_vertices(std::span<const Value> values) = 0;
  /// Each simplex comes once: the places of its corners in `values`.
  virtual void take_simplices(std::span<const Value> values,
                              std::span<const std::uint32_t> corners) = 0;

  const std::size_t corners_;
  StreamVertices<Value> live_;  ///< of write() alone
};

}  // namespace spillway::stream

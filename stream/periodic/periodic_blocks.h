#pragma once

#include <cstdint>
#include <vector>

#include <spillway/detail/probing_table.h>
#include <spillway/live_vertices.h>
#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/periodic_domain.h"
#include "src/runtime/memory_budget.h"

namespace spillway::stream {

/// Makes of the blocks of an engine in a periodic domain those of the periodic mesh: copies of a
/// vertex become one vertex, in the box, and corners get their offsets. The engine's vertices carry
/// their index in the input, by which copies are known.
class PeriodicBlocks final : public BlockSink {
 public:
  /// `sink` gets the blocks, with input indices if `input_index`; it, `domain` and `budget` must
  /// outlive this.
  PeriodicBlocks(BlockSink& sink, const PeriodicDomain& domain, bool input_index,
                 MemoryBudget& budget);

  void absorb(MeshStreamBlock& block) override;
  void write(MeshStreamBlock&& block) override;
  /// Finalizes what is left. Does not finish the sink.
  void finish(const MeshTotals& totals) override;

  /// Of the periodic mesh so far.
  [[nodiscard]] std::uint64_t vertices() const { return vertices_; }

 private:
  /// A vertex of the engine that is a copy, or has some.
  struct Copy {
    std::uint64_t vertex = 0;  ///< of the periodic mesh
    std::uint64_t index = 0;   ///< of its point
    CornerOffset offset = kNoOffset;
  };
  /// A point that has copies, by its index in the input.
  struct SharedPoint {
    static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
    std::uint64_t index = kEmpty;
    std::uint64_t vertex = 0;
    std::uint32_t left = 0;  ///< copies, itself among them, that are not finalized

    [[nodiscard]] bool empty() const { return index == kEmpty; }
    [[nodiscard]] std::uint64_t scattered() const { return detail::scatter(index); }
    [[nodiscard]] bool same_key(const SharedPoint& other) const { return index == other.index; }
  };
  /// A block without copies, as the sink has absorbed it.
  struct Absorbed;
  /// What becomes of a vertex of the engine's block.
  struct Corner {
    std::uint32_t number = 0;  ///< short, in the new block
    CornerOffset offset = kNoOffset;
  };

  [[nodiscard]] bool has_copies(const MeshStreamBlock& block) const;
  [[nodiscard]] CornerOffset wrap(LatticePoint& point) const;
  void take_vertices(MeshStreamBlock& block, MeshStreamBlock& made);
  void take_imported(const MeshStreamBlock& block, MeshStreamBlock& made);
  void take_corners(const MeshStreamBlock& block, MeshStreamBlock& made);
  void take_finalized(const MeshStreamBlock& block, MeshStreamBlock& made);
  bool is_last(const Copy& copy);
  [[nodiscard]] std::uint32_t copies_of(const LatticePoint& point) const;
  [[nodiscard]] std::uint32_t import(std::uint64_t vertex, MeshStreamBlock& made);
  [[nodiscard]] std::uint64_t vertex_of(std::uint64_t engine_number) const;
  void lease();

  BlockSink& sink_;
  const PeriodicDomain& domain_;
  const bool input_index_;
  ShrinkingLease memory_;
  std::uint64_t leased_ = 0;  ///< bytes
  std::uint64_t engine_vertices_ = 0;
  std::uint64_t vertices_ = 0;
  detail::ProbingTable<SharedPoint> shared_;
  LiveVertices<Copy> copies_;            ///< by the engine's numbers
  std::vector<std::uint64_t> dropped_;   ///< the engine's numbers of copies that are no new vertex
  std::vector<Corner> map_;              ///< of the block that is written, by short number
  LiveVertices<std::uint32_t> imports_;  ///< likewise: short numbers of imported vertices
};

}  // namespace spillway::stream

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "src/distributed/merge_halves.h"
#include "src/distributed/ranks.h"
#include "stream/plan/run_setup.h"
#include "stream/plan/run_trace.h"
#include "stream/ranks/merges/owned_vertices.h"
#include "stream/ranks/rank_tree.h"
#include "stream/triangulate/tile_engine.h"

namespace spillway::ranks {

/// Merges what the tiles of ranks have left, up the tree of ranks (Algorithms 2 and 3 of Funke,
/// Sanders 2017). The border of a node stays with the ranks that made it: each holds a share of its
/// simplices, and what its own vertices carry.
template <int D>
class RankMerges {
 public:
  /// Makes the groups of ranks that merge. All must outlive it. Collective.
  RankMerges(const RankTree<D>& tree, TileEngine<D>& engine, const RunSetup& setup,
             const distributed::Ranks& ranks);

  /// Merges what this rank's tiles have left, whose vertices have their places in the stream of all
  /// ranks, with what those of others have. Collective, of the ranks that have points.
  void run(Border<D> border);

  /// What this rank's share has become: sections in the order of the stream, and how it went.
  [[nodiscard]] std::vector<SectionDraft> take_sections() { return std::move(sections_); }
  [[nodiscard]] std::vector<RankMerge> take_statistics() { return std::move(statistics_); }

 private:
  using Node = typename RankTree<D>::Node;
  using Corners = std::array<VertexId, D + 1>;
  /// A merge that this rank takes part in, and those who do.
  struct Step {
    const Node* node = nullptr;
    distributed::Ranks ranks;
  };
  using News = distributed::ItemsByRank<VertexNews>;
  /// What this rank tells owners of a merge, and of which vertices of the share it asks them.
  struct Told {
    News news;
    distributed::ItemsByRank<VertexId> used;
    std::vector<std::uint8_t> held;  ///< by vertex of the share
  };

  [[nodiscard]] std::vector<std::uint32_t> exposure_of_new(std::size_t merges_done) const;
  void merge(const Step& step);
  void merge_halves(const Step& step, distributed::ItemLimits limits, Task& task,
                    RankMerge& statistics);
  void settle(const Step& step, const distributed::ItemLimits& limits, Task& task);
  std::uint64_t hull_facets_of(std::span<const Corners> infinite);
  [[nodiscard]] Told news_of(const std::vector<Corners>& finals);
  [[nodiscard]] Border<D> fetch_used(const distributed::Group& group, const News& asked,
                                     const distributed::ItemLimits& limits) const;
  std::optional<SectionDraft> emit(Border<D> finals, std::uint32_t section);
  void keep(std::optional<SectionDraft> draft);
  void hold();

  const RankTree<D>& tree_;
  TileEngine<D>& engine_;
  MemoryBudget& budget_;
  const EngineOptions& options_;
  OutputOptions output_;
  std::size_t largest_message_ = 0;  ///< bytes
  int member_ = 0;
  std::vector<Step> steps_;  ///< from the root down
  Outside<D> other_halves_;  ///< by merge that this rank takes part in, from the lowest on
  std::optional<OwnedVertices<D>> owned_;
  std::optional<distributed::GrowingShare<D>> share_;
  std::vector<std::uint8_t> held_;  ///< by vertex of the share, whether its simplices have it
  ShrinkingLease kept_;             ///< of sections
  std::vector<SectionDraft> sections_;
  std::vector<RankMerge> statistics_;
};

}  // namespace spillway::ranks

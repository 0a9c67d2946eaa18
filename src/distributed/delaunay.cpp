#include "src/distributed/delaunay.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "src/delaunay/border/exposure.h"
#include "src/distributed/box_tree.h"
#include "src/distributed/group.h"
#include "src/distributed/growing_share.h"
#include "src/distributed/merge_halves.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"

namespace spillway::distributed {
namespace {

/// One triangulation: of the input, or of the border of two groups.
template <int D>
class Run {
  using Corners = std::array<VertexId, D + 1>;

 public:
  Run(const Ranks& ranks, const DistributedOptions<D>& options)
      : ranks_(ranks), options_(options) {}

  Share<D> triangulate(std::vector<NamedPoint<D>> points) {
    triangulate_group({ranks_, 0}, std::move(points));
    return complete_share();
  }

 private:
  void triangulate_group(const Group& group, std::vector<NamedPoint<D>> points) {
    const Ranks& ranks = group.ranks;
    if (ranks.size() == 1) {
      triangulate_own(std::move(points));
      return;
    }
    const int low_ranks = ranks.size() / 2;
    points = move_to_half(std::move(points), ranks, low_ranks, options_.limits);
    const int middle = group.first + low_ranks;
    const bool high = group.own() >= middle;
    {
      const Ranks half = ranks.split(high ? 1 : 0);
      triangulate_group({half, high ? middle : group.first}, std::move(points));
    }
    const HalvesMerged merged = merge_halves(*growing_, group, middle, merges_++, options_);
    options_.inner_merge(merged.border);
    settle();
  }

  void triangulate_own(std::vector<NamedPoint<D>> named) {
    std::vector<Point<D>> points(named.size());
    std::ranges::transform(named, points.begin(), &NamedPoint<D>::position);
    Box<D> box;
    for (const Point<D>& point : points) box.expand(point);
    begin_share(options_.triangulate(std::move(points)), named);
    named = {};
    boxes_ = gather_item(ranks_, box);
    note_other_halves(0, ranks_.size());
    settle();
  }

  /// The other halves of all merges that this rank takes part in, of ranks from `begin` to `end`.
  void note_other_halves(int begin, int end) {
    if (end - begin < 2) return;
    const int middle = begin + (end - begin) / 2;
    const bool high = ranks_.rank() >= middle;
    note_other_halves(high ? middle : begin, high ? end : middle);
    const int other = high ? begin : middle;
    other_halves_.push_back(
        BoxTree<D>::of(std::span(boxes_).subspan(other, (high ? middle : end) - other)));
  }

  /// The share begins with the triangulation of the own points, equal ones made one.
  void begin_share(const Triangulation<D>& triangulation, std::span<const NamedPoint<D>> named) {
    std::vector<VertexId> renumbered(triangulation.points.size());
    std::vector<Point<D>> points;
    auto duplicate = triangulation.duplicates.begin();
    const auto origin = [&](VertexId v) { return named[triangulation.input_index[v]].name; };
    for (VertexId v = 0; v < renumbered.size(); ++v) {
      if (duplicate != triangulation.duplicates.end() && duplicate->dropped == v) {
        duplicates_.push_back({origin(v), origin(duplicate->kept)});
        ++duplicate;
        continue;
      }
      renumbered[v] = static_cast<VertexId>(points.size());
      points.push_back(triangulation.points[v]);
      origins_.push_back(origin(v));
    }
    std::ranges::sort(duplicates_, {}, &Share<D>::Duplicate::dropped);
    std::vector<Corners> simplices;
    triangulation.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
      Corners& corners = simplices.emplace_back(simplex.vertices);
      for (VertexId& v : corners) v = v == kInfiniteVertex ? v : renumbered[v];
    });
    growing_.emplace(ranks_.rank(), std::move(points), std::move(simplices),
                     triangulation.dimension);
  }

  /// What nothing can change of what is new stays as it is.
  void settle() {
    std::vector<const BoxTree<D>*> trees;
    for (const BoxTree<D>& tree : other_halves_) trees.push_back(&tree);
    const auto settled = growing_->settle(
        exposure_by_tree<D, BoxTree<D>>(growing_->unsettled(), growing_->points(), trees, merges_));
    settled_.insert(settled_.end(), settled.begin(), settled.end());
  }

  /// What this rank holds in the end, of vertices only those that occur.
  Share<D> complete_share() {
    const std::span<const Corners> rest = growing_->simplices();
    settled_.insert(settled_.end(), rest.begin(), rest.end());
    Share<D> share;
    share.dimension = growing_->dimension();
    share.duplicates = std::move(duplicates_);
    share.origins = std::move(origins_);
    share.own = growing_->own_points();
    std::vector<std::uint8_t> used(growing_->points().size());
    for (const Corners& corners : settled_) {
      for (const VertexId v : corners) {
        if (v != kInfiniteVertex) used[v] = 1;
      }
    }
    std::vector<VertexId> number(used.size());
    for (VertexId v = 0; v < used.size(); ++v) {
      if (v >= share.own && used[v] == 0) continue;
      number[v] = static_cast<VertexId>(share.points.size());
      share.points.push_back(growing_->points()[v]);
      share.names.push_back(growing_->names()[v]);
    }
    for (Corners& corners : settled_) {
      for (VertexId& v : corners) v = v == kInfiniteVertex ? v : number[v];
    }
    share.simplices = std::move(settled_);
    growing_.reset();
    ask_for_origins(share);
    return share;
  }

  /// Completes the share by the origins of vertices elsewhere, which only their owners know.
  void ask_for_origins(Share<D>& share) {
    share.origins.resize(share.points.size());
    ItemsByRank<std::uint32_t> questions;
    ItemsByRank<VertexId> asked_for;
    for (auto v = static_cast<VertexId>(share.own); v < share.points.size(); ++v) {
      questions[static_cast<int>(share.names[v].rank)].push_back(share.names[v].index);
      asked_for[static_cast<int>(share.names[v].rank)].push_back(v);
    }
    ItemsByRank<RankIndex> answers;
    for (const auto& [rank, indices] :
         exchange_items(ranks_, std::move(questions), options_.limits)) {
      for (const std::uint32_t index : indices) answers[rank].push_back(share.origins[index]);
    }
    for (const auto& [rank, origins] :
         exchange_items(ranks_, std::move(answers), options_.limits)) {
      for (std::size_t i = 0; i < origins.size(); ++i) {
        share.origins[asked_for[rank][i]] = origins[i];
      }
    }
  }

  const Ranks& ranks_;
  const DistributedOptions<D>& options_;
  std::optional<GrowingShare<D>> growing_;
  std::vector<RankIndex> origins_;  ///< of its own points
  std::vector<typename Share<D>::Duplicate> duplicates_;
  std::vector<Corners> settled_;          ///< simplices that no merge to come can change
  std::vector<Box<D>> boxes_;             ///< of each rank's points
  std::vector<BoxTree<D>> other_halves_;  ///< by merge that this rank takes part in
  unsigned merges_ = 0;                   ///< that are done
};

}  // namespace

template <int D>
Share<D> delaunay_triangulation(std::vector<NamedPoint<D>> points, const Ranks& ranks,
                                const DistributedOptions<D>& options) {
  if (points.size() > kMaxVertices) {
    throw Failure("rank " + std::to_string(ranks.rank()) + " has more than " +
                      std::to_string(kMaxVertices) + " points: use more ranks",
                  ErrorCode::kTooLarge);
  }
  return Run<D>(ranks, options).triangulate(std::move(points));
}

#define SPILLWAY_INSTANTIATE(D)                                                         \
  template Share<D> delaunay_triangulation<D>(std::vector<NamedPoint<D>>, const Ranks&, \
                                              const DistributedOptions<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::distributed

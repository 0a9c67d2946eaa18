#include "src/distributed/delaunay.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "src/delaunay/delaunay.h"
#include "src/distributed/box_tree.h"
#include "src/distributed/growing_share.h"
#include "src/distributed/halving.h"
#include "src/distributed/items.h"
#include "src/error.h"

namespace spillway::detail::distributed {
namespace {

/// A group of ranks and the number of its first one in the run.
struct Group {
  const Ranks& ranks;
  int first;
};

/// exchange_items() within a group, of items by their rank in the run.
template <typename T>
ItemsByRank<T> exchange_within(const Group& group, ItemsByRank<T> items) {
  ItemsByRank<T> shifted;
  for (auto& [rank, some] : items) shifted[rank - group.first] = std::move(some);
  return exchange_items(group.ranks, shifted);
}

template <std::size_t N>
std::array<std::uint64_t, N> reduced(std::array<std::uint64_t, N> values, Reduction reduction,
                                     const Ranks& ranks) {
  ranks.reduce(values, reduction);
  return values;
}

/// One triangulation: of the input, or of the border of two groups.
template <int D>
class Run {
 public:
  Run(const Ranks& ranks, const DistributedOptions& options) : ranks_(ranks), options_(options) {}

  Share<D> triangulate(std::vector<NamedPoint<D>> points) {
    triangulate_group({ranks_, 0}, std::move(points));
    Share<D> share = growing_->take();
    ask_for_origins(share);
    return share;
  }

 private:
  void triangulate_group(const Group& group, std::vector<NamedPoint<D>> points) {
    const Ranks& ranks = group.ranks;
    if (ranks.size() == 1) {
      triangulate_own(std::move(points));
      return;
    }
    const int low_ranks = ranks.size() / 2;
    points = move_to_half(std::move(points), ranks, low_ranks);
    const bool high = ranks.rank() >= low_ranks;
    const int middle = group.first + low_ranks;
    {
      const Ranks half = ranks.split(high ? 1 : 0);
      triangulate_group({half, high ? middle : group.first}, std::move(points));
    }
    merge(group, middle);
  }

  void triangulate_own(std::vector<NamedPoint<D>> points) {
    std::vector<Point<D>> positions(points.size());
    std::transform(points.begin(), points.end(), positions.begin(),
                   [](const NamedPoint<D>& point) { return point.position; });
    growing_.emplace(ranks_.rank(),
                     spillway::detail::delaunay<D>(positions, {.threads = options_.threads}),
                     points);
    Box<D> box;
    for (const Point<D>& position : positions) box.expand(position);
    boxes_ = gather_item(ranks_, box);
    settle({ranks_, ranks_.rank()}, 1);
  }

  /// What no rank outside of `count` ones of the group can change stays as it is.
  void settle(const Group& group, int count) {
    const std::span boxes(boxes_);
    const auto after = static_cast<std::size_t>(group.first + count);
    std::vector<BoxTree<D>> outside;
    if (group.first > 0) outside.push_back(BoxTree<D>::of(boxes.first(group.first)));
    if (after < boxes.size()) outside.push_back(BoxTree<D>::of(boxes.subspan(after)));
    std::vector<const BoxTree<D>*> trees;
    for (const BoxTree<D>& tree : outside) trees.push_back(&tree);
    growing_->settle(trees);
  }

  /// From the triangulations of a group's halves to that of the group. The upper half begins at
  /// rank `middle`.
  void merge(const Group& group, int middle) {
    const int end = group.first + group.ranks.size();
    const bool high = ranks_.rank() >= middle;
    std::array<std::uint64_t, 2> own_dimension{};  // plus 1: 0 without points
    own_dimension[high] = static_cast<std::uint64_t>(growing_->share().dimension) + 1;
    const auto dimensions = reduced(own_dimension, Reduction::kMost, group.ranks);
    const auto most = std::max(dimensions[0], dimensions[1]);
    growing_->set_dimension(static_cast<int>(most) - 1);
    if (dimensions[0] == 0 || dimensions[1] == 0) return;  // one half has no points

    const std::array open = {dimensions[0] <= D, dimensions[1] <= D};
    const std::span boxes(boxes_);
    const BoxTree<D> others = BoxTree<D>::of(high ? boxes.subspan(group.first, middle - group.first)
                                                  : boxes.subspan(middle, end - middle));
    const Share<D> border = triangulate_border(group, complete_border(group, others, open[high]));
    const auto dimension = reduced<1>({static_cast<std::uint64_t>(border.dimension) + 1},
                                      Reduction::kMost, group.ranks);
    growing_->set_dimension(static_cast<int>(std::max(most, dimension[0])) - 1);
    take_over(group, border, middle, open);
    settle(group, group.ranks.size());
  }

  /// The own vertices of the group's border: those that this rank finds, and those that others find
  /// in simplices that they share with it.
  std::vector<VertexId> complete_border(const Group& group, const BoxTree<D>& others, bool open) {
    std::vector<VertexId> border;
    ItemsByRank<VertexId> elsewhere;
    for (const RankIndex name : growing_->expose(others)) {
      const auto owner = static_cast<int>(name.rank);
      (owner == ranks_.rank() ? border : elsewhere[owner]).push_back(name.index);
    }
    for (const auto& [rank, some] : exchange_within(group, std::move(elsewhere))) {
      border.insert(border.end(), some.begin(), some.end());
    }
    if (open) {
      border.resize(growing_->share().own);
      std::iota(border.begin(), border.end(), VertexId{0});
    }
    std::sort(border.begin(), border.end());
    border.erase(std::unique(border.begin(), border.end()), border.end());
    return border;
  }

  /// Triangulates a group's border by its first ranks: by half of them, or by one if it is small.
  /// Its points' origins are the names of vertices in this run. An empty share at the other ranks.
  Share<D> triangulate_border(const Group& group, const std::vector<VertexId>& border) {
    const int size = group.ranks.size();
    const auto [whole] = reduced<1>({border.size()}, Reduction::kSum, group.ranks);
    const int workers = whole < options_.gather_below ? 1 : size / 2;
    ItemsByRank<NamedPoint<D>> moving;
    const int worker = group.ranks.rank() * workers / size;
    for (const VertexId v : border) {
      moving[worker].push_back({growing_->share().points[v], growing_->share().names[v]});
    }
    std::vector<NamedPoint<D>> points;
    for (const auto& [rank, some] : exchange_items(group.ranks, moving)) {
      points.insert(points.end(), some.begin(), some.end());
    }
    const bool works = group.ranks.rank() < workers;
    const Ranks split = group.ranks.split(works ? 0 : 1);
    return works ? Run(split, options_).triangulate(std::move(points)) : Share<D>{};
  }

  /// Sends the simplices of the border's triangulation to those whose shares they may belong to:
  /// each to the owner of its vertex of the least name.
  void take_over(const Group& group, const Share<D>& border, int middle,
                 const std::array<bool, 2>& open) {
    ItemsByRank<NamedSimplex<D>> simplices;
    std::vector<std::pair<std::uint32_t, VertexId>> unknown;  // at a rank, a vertex of `border`
    for (const auto& corners : border.simplices) {
      NamedSimplex<D> named;
      std::ranges::transform(corners, named.begin(), [&](VertexId v) {
        return v == kInfiniteVertex ? kInfiniteName : border.origins[v];
      });
      const std::uint32_t holder = std::ranges::min(named).rank;
      simplices[static_cast<int>(holder)].push_back(named);
      for (int i = 0; i <= D; ++i) {
        if (named[i] != kInfiniteName && named[i].rank != holder) {
          unknown.emplace_back(holder, corners[i]);
        }
      }
    }
    std::sort(unknown.begin(), unknown.end());
    unknown.erase(std::unique(unknown.begin(), unknown.end()), unknown.end());
    ItemsByRank<NamedPoint<D>> points;
    for (const auto& [rank, v] : unknown) {
      points[static_cast<int>(rank)].push_back({border.points[v], border.origins[v]});
    }
    const auto simplices_here = exchange_within(group, std::move(simplices));
    const auto points_here = exchange_within(group, std::move(points));
    growing_->accept(simplices_here, points_here, middle, open);
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
    for (const auto& [rank, indices] : exchange_items(ranks_, questions)) {
      for (const std::uint32_t index : indices) answers[rank].push_back(share.origins[index]);
    }
    for (const auto& [rank, origins] : exchange_items(ranks_, answers)) {
      for (std::size_t i = 0; i < origins.size(); ++i) {
        share.origins[asked_for[rank][i]] = origins[i];
      }
    }
  }

  const Ranks& ranks_;
  const DistributedOptions& options_;
  std::optional<GrowingShare<D>> growing_;
  std::vector<Box<D>> boxes_;  ///< of each rank's points
};

}  // namespace

template <int D>
Share<D> delaunay(const std::vector<Point<D>>& local_points, const Ranks& ranks,
                  const DistributedOptions& options) {
  if (local_points.size() > kMaxVertices) {
    throw Error("rank " + std::to_string(ranks.rank()) + " has more than " +
                    std::to_string(kMaxVertices) + " points: use more ranks",
                ErrorCode::kTooLarge);
  }
  std::vector<NamedPoint<D>> points(local_points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {local_points[i],
                 {static_cast<std::uint32_t>(ranks.rank()), static_cast<std::uint32_t>(i)}};
  }
  return Run<D>(ranks, options).triangulate(std::move(points));
}

template Share<2> delaunay<2>(const std::vector<Point<2>>&, const Ranks&,
                              const DistributedOptions&);
template Share<3> delaunay<3>(const std::vector<Point<3>>&, const Ranks&,
                              const DistributedOptions&);

}  // namespace spillway::detail::distributed

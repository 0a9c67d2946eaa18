#include "src/distributed/delaunay.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "src/delaunay/delaunay.h"
#include "src/distributed/halving.h"
#include "src/distributed/items.h"
#include "src/distributed/view_builder.h"
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

  View<D> triangulate(std::vector<NamedPoint<D>> points) {
    triangulate_group({ranks_, 0}, std::move(points));
    builder_->compact();
    ask_for_origins();
    return std::move(builder_->view);
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
    builder_.emplace(ranks_.rank(),
                     spillway::detail::delaunay<D>(positions, {.threads = options_.threads}),
                     points);
    Box<D> box;
    for (const Point<D>& position : positions) box.expand(position);
    boxes_ = gather_item(ranks_, box);
  }

  /// From the triangulations of a group's halves to that of the group. The upper half begins at
  /// rank `middle`.
  void merge(const Group& group, int middle) {
    View<D>& view = builder_->view;
    const int end = group.first + group.ranks.size();
    const bool high = ranks_.rank() >= middle;
    std::array<std::uint64_t, 2> own_dimension{};  // plus 1: 0 without points
    own_dimension[high] = static_cast<std::uint64_t>(view.dimension) + 1;
    const auto dimensions = reduced(own_dimension, Reduction::kMost, group.ranks);
    view.dimension = static_cast<int>(*std::max_element(dimensions.begin(), dimensions.end())) - 1;
    const bool open = dimensions[high] <= D;
    if (dimensions[0] == 0 || dimensions[1] == 0) return;  // one half has no points

    const std::span boxes(boxes_);
    const BoxTree<D> others =
        tree_of_boxes<D>(high ? boxes.subspan(group.first, middle - group.first)
                              : boxes.subspan(middle, end - middle));
    const View<D> border = triangulate_border(group, complete_border(group, others, open));
    const auto dimension = reduced<1>({static_cast<std::uint64_t>(border.dimension) + 1},
                                      Reduction::kMost, group.ranks);
    view.dimension = std::max(view.dimension, static_cast<int>(dimension[0]) - 1);
    take_over(group, border, high ? middle : group.first, high ? end : middle, open);
  }

  /// The own vertices of the group's border: those that this rank finds, and those that others find
  /// in simplices that they share with it.
  std::vector<VertexId> complete_border(const Group& group, const BoxTree<D>& others, bool open) {
    std::vector<VertexId> border;
    ItemsByRank<VertexId> elsewhere;
    for (const RankIndex name : builder_->find_border(others)) {
      const auto owner = static_cast<int>(name.rank);
      (owner == ranks_.rank() ? border : elsewhere[owner]).push_back(name.index);
    }
    for (const auto& [rank, some] : exchange_within(group, std::move(elsewhere))) {
      border.insert(border.end(), some.begin(), some.end());
    }
    if (open) {
      border.resize(builder_->view.own);
      std::iota(border.begin(), border.end(), VertexId{0});
    }
    std::sort(border.begin(), border.end());
    border.erase(std::unique(border.begin(), border.end()), border.end());
    return border;
  }

  /// Triangulates a group's border by its first ranks: by half of them, or by one if it is small.
  /// Its points' origins are the names of vertices in this run. An empty view at the other ranks.
  View<D> triangulate_border(const Group& group, const std::vector<VertexId>& border) {
    const int size = group.ranks.size();
    const auto [whole] = reduced<1>({border.size()}, Reduction::kSum, group.ranks);
    const int workers = whole < options_.gather_below ? 1 : size / 2;
    ItemsByRank<NamedPoint<D>> moving;
    const int worker = group.ranks.rank() * workers / size;
    for (const VertexId v : border) {
      moving[worker].push_back({builder_->view.points[v], builder_->view.names[v]});
    }
    std::vector<NamedPoint<D>> points;
    for (const auto& [rank, some] : exchange_items(group.ranks, moving)) {
      points.insert(points.end(), some.begin(), some.end());
    }
    const bool works = group.ranks.rank() < workers;
    const Ranks split = group.ranks.split(works ? 0 : 1);
    return works ? Run(split, options_).triangulate(std::move(points)) : View<D>{};
  }

  /// Sends the simplices of the border's triangulation, each by the owner of its least vertex
  /// there, to those who own their vertices here, and makes them part of the views.
  void take_over(const Group& group, const View<D>& border, int first_rank, int end_rank,
                 bool open) {
    ItemsByRank<NamedSimplex<D>> simplices;
    std::vector<std::pair<std::uint32_t, VertexId>> unknown;  // at a rank, a vertex of `border`
    for (const Simplex<D>& simplex : border.simplices) {
      if (!tells(border, simplex)) continue;
      NamedSimplex<D> named;
      std::vector<std::uint32_t> owners;
      for (int i = 0; i <= D; ++i) {
        const VertexId v = simplex.vertices[i];
        named[i] = v == kInfiniteVertex ? kInfiniteName : border.origins[v];
        if (v != kInfiniteVertex) owners.push_back(named[i].rank);
      }
      std::sort(owners.begin(), owners.end());
      owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
      for (const std::uint32_t owner : owners) {
        simplices[static_cast<int>(owner)].push_back(named);
        for (int i = 0; i <= D; ++i) {
          if (named[i] != kInfiniteName && named[i].rank != owner) {
            unknown.emplace_back(owner, simplex.vertices[i]);
          }
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
    builder_->accept(simplices_here, points_here, first_rank, end_rank, open);
    builder_->apply(exchange_within(group, builder_->link()));
  }

  /// Whether this rank is the one that tells others of a simplex of its view.
  static bool tells(const View<D>& view, const Simplex<D>& simplex) {
    VertexId least = kInfiniteVertex;
    for (const VertexId v : simplex.vertices) {
      if (v == kInfiniteVertex) continue;
      if (least == kInfiniteVertex || view.names[v] < view.names[least]) least = v;
    }
    return least < view.own;
  }

  /// Completes the view by the origins of vertices elsewhere, which only their owners know.
  void ask_for_origins() {
    View<D>& view = builder_->view;
    view.origins.resize(view.points.size());
    ItemsByRank<std::uint32_t> questions;
    ItemsByRank<VertexId> asked_for;
    for (auto v = static_cast<VertexId>(view.own); v < view.points.size(); ++v) {
      questions[static_cast<int>(view.names[v].rank)].push_back(view.names[v].index);
      asked_for[static_cast<int>(view.names[v].rank)].push_back(v);
    }
    ItemsByRank<RankIndex> answers;
    for (const auto& [rank, indices] : exchange_items(ranks_, questions)) {
      for (const std::uint32_t index : indices) answers[rank].push_back(view.origins[index]);
    }
    for (const auto& [rank, origins] : exchange_items(ranks_, answers)) {
      for (std::size_t i = 0; i < origins.size(); ++i) {
        view.origins[asked_for[rank][i]] = origins[i];
      }
    }
  }

  const Ranks& ranks_;
  const DistributedOptions& options_;
  std::optional<ViewBuilder<D>> builder_;
  std::vector<Box<D>> boxes_;  ///< of each rank's points
};

}  // namespace

template <int D>
View<D> delaunay(const std::vector<Point<D>>& local_points, const Ranks& ranks,
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

template View<2> delaunay<2>(const std::vector<Point<2>>&, const Ranks&, const DistributedOptions&);
template View<3> delaunay<3>(const std::vector<Point<3>>&, const Ranks&, const DistributedOptions&);

}  // namespace spillway::detail::distributed

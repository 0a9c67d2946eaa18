#include "src/distributed/merge_halves.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "src/geometry/dimensions.h"

namespace spillway::distributed {
namespace {

template <std::size_t N>
std::array<std::uint64_t, N> most_of(std::array<std::uint64_t, N> values, const Ranks& ranks) {
  ranks.reduce(values, Reduction::kMost);
  return values;
}

template <int D>
class Merge {
 public:
  Merge(GrowingShare<D>& share, const Group& group, int middle,
        const DistributedOptions<D>& options)
      : share_(share), group_(group), options_(options), halves_{.middle = middle} {}

  HalvesMerged run(unsigned merge) {
    const bool high = group_.own() >= halves_.middle;
    std::array<std::uint64_t, 2> own_dimension{};  // plus 1: 0 without points
    own_dimension[high] = static_cast<std::uint64_t>(share_.dimension()) + 1;
    const auto dimensions = most_of(own_dimension, group_.ranks);
    const auto most = std::max(dimensions[0], dimensions[1]);
    share_.set_dimension(static_cast<int>(most) - 1);
    if (dimensions[0] == 0 || dimensions[1] == 0) return result_;  // one half has no points

    halves_.open = {dimensions[0] <= D, dimensions[1] <= D};
    const Share<D> border = triangulate_border(complete_border(merge, halves_.open[high]));
    const auto [dimension] =
        most_of<1>({static_cast<std::uint64_t>(border.dimension) + 1}, group_.ranks);
    share_.set_dimension(static_cast<int>(std::max(most, dimension)) - 1);
    take_over(border);
    return result_;
  }

 private:
  /// The own vertices of the group's border: those that this rank finds, and those that others find
  /// in simplices that they share with it.
  std::vector<VertexId> complete_border(unsigned merge, bool open) {
    const std::size_t simplices = share_.simplices().size();
    std::vector<VertexId> border;
    ItemsByRank<VertexId> elsewhere;
    for (const RankIndex name : share_.put_apart(merge)) {
      const auto owner = static_cast<int>(name.rank);
      (owner == group_.own() ? border : elsewhere[owner]).push_back(name.index);
    }
    result_.put_apart = simplices - share_.simplices().size();
    for (const auto& [rank, some] :
         exchange_within(group_, std::move(elsewhere), options_.limits)) {
      border.insert(border.end(), some.begin(), some.end());
    }
    if (open) {
      border.resize(share_.own_points());
      std::iota(border.begin(), border.end(), VertexId{0});
    }
    std::sort(border.begin(), border.end());
    border.erase(std::unique(border.begin(), border.end()), border.end());
    return border;
  }

  /// Triangulates the group's border by its first ranks: by half of them, or by one if it is small.
  /// Its points' origins are their names here. An empty share at the other ranks.
  Share<D> triangulate_border(const std::vector<VertexId>& border) {
    const int size = group_.ranks.size();
    result_.border = border.size();
    group_.ranks.reduce(std::span(&result_.border, 1), Reduction::kSum);
    const int workers = result_.border < options_.gather_below ? 1 : size / 2;
    ItemsByRank<NamedPoint<D>> moving;
    const int worker = group_.ranks.rank() * workers / size;
    for (const VertexId v : border) {
      moving[worker].push_back({share_.points()[v], share_.names()[v]});
    }
    std::vector<NamedPoint<D>> points;
    for (auto& [rank, some] : exchange_items(group_.ranks, std::move(moving), options_.limits)) {
      points.insert(points.end(), some.begin(), some.end());
      some = {};
    }
    const bool works = group_.ranks.rank() < workers;
    const Ranks split = group_.ranks.split(works ? 0 : 1);
    result_.triangulated = points.size();
    return works ? delaunay_triangulation<D>(std::move(points), split, options_) : Share<D>{};
  }

  /// Sends the simplices of the border's triangulation to those whose shares they may belong to:
  /// each to the owner of its vertex of the least name.
  void take_over(const Share<D>& border) {
    const auto ranks = static_cast<std::size_t>(group_.ranks.size());
    std::vector<std::vector<NamedSimplex<D>>> named(ranks);
    std::vector<std::vector<std::uint32_t>> places(ranks);
    for (std::uint32_t s = 0; s < border.simplices.size(); ++s) {
      NamedSimplex<D> names;
      std::ranges::transform(border.simplices[s], names.begin(), [&](VertexId v) {
        return v == kInfiniteVertex ? kInfiniteName : border.origins[v];
      });
      const auto holder = static_cast<int>(std::ranges::min(names).rank) - group_.first;
      named[holder].push_back(names);
      places[holder].push_back(s);
    }
    ItemsByRank<NamedSimplex<D>> simplices;
    ItemsByRank<NamedPoint<D>> points;
    std::vector<int> sent_to(border.points.size(), -1);  // by point, last
    for (std::size_t r = 0; r < ranks; ++r) {
      if (named[r].empty()) continue;
      const int holder = group_.first + static_cast<int>(r);
      simplices[holder] = std::move(named[r]);
      for (const std::uint32_t s : places[r]) {
        for (const VertexId v : border.simplices[s]) {
          if (v == kInfiniteVertex || std::exchange(sent_to[v], holder) == holder) continue;
          if (static_cast<int>(border.origins[v].rank) == holder) continue;
          points[holder].push_back({border.points[v], border.origins[v]});
        }
      }
    }
    const auto simplices_here = exchange_within(group_, std::move(simplices), options_.limits);
    const auto points_here = exchange_within(group_, std::move(points), options_.limits);
    share_.accept(simplices_here, points_here, halves_);
  }

  GrowingShare<D>& share_;
  const Group& group_;
  const DistributedOptions<D>& options_;
  Halves halves_;
  HalvesMerged result_;
};

}  // namespace

template <int D>
HalvesMerged merge_halves(GrowingShare<D>& share, const Group& group, int middle, unsigned merge,
                          const DistributedOptions<D>& options) {
  return Merge<D>(share, group, middle, options).run(merge);
}

#define SPILLWAY_INSTANTIATE(D)                                                        \
  template HalvesMerged merge_halves<D>(GrowingShare<D>&, const Group&, int, unsigned, \
                                        const DistributedOptions<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::distributed

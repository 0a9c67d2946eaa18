#include "src/distributed/growing_share.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "src/delaunay/border/acceptance.h"
#include "src/delaunay/border/exposure.h"
#include "src/error.h"

namespace spillway::detail::distributed {
namespace {

std::uint64_t key(RankIndex name) { return (std::uint64_t{name.rank} << 32U) | name.index; }

}  // namespace

template <int D>
GrowingShare<D>::GrowingShare(int rank, const Triangulation<D>& triangulation,
                              std::span<const NamedPoint<D>> points)
    : rank_(rank) {
  share_.dimension = triangulation.dimension;
  std::vector<VertexId> renumbered(triangulation.points.size());
  auto duplicate = triangulation.duplicates.begin();
  const auto origin = [&](VertexId v) { return points[triangulation.input_index[v]].name; };
  for (VertexId v = 0; v < renumbered.size(); ++v) {
    if (duplicate != triangulation.duplicates.end() && duplicate->dropped == v) {
      share_.duplicates.push_back({origin(v), origin(duplicate->kept)});
      ++duplicate;
      continue;
    }
    renumbered[v] = static_cast<VertexId>(share_.points.size());
    share_.names.push_back({static_cast<std::uint32_t>(rank), renumbered[v]});
    share_.points.push_back(triangulation.points[v]);
    share_.origins.push_back(origin(v));
  }
  share_.own = share_.points.size();
  std::ranges::sort(share_.duplicates, {}, &Share<D>::Duplicate::dropped);
  triangulation.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
    Corners& corners = open_.emplace_back(simplex.vertices);
    for (VertexId& v : corners) v = v == kInfiniteVertex ? v : renumbered[v];
  });
}

template <int D>
VertexId GrowingShare<D>::vertex_named(RankIndex name) const {
  if (name == kInfiniteName) return kInfiniteVertex;
  if (name.rank == static_cast<std::uint32_t>(rank_)) return name.index;
  const auto found = foreign_.find(key(name));
  if (found == foreign_.end()) {
    throw std::logic_error("merge of shares: a vertex of another rank without a position");
  }
  return found->second;
}

template <int D>
void GrowingShare<D>::add_vertex(const NamedPoint<D>& point) {
  const auto number = static_cast<VertexId>(share_.points.size());
  if (!foreign_.emplace(key(point.name), number).second) return;
  if (number >= kMaxVertices) {
    throw Error("one rank's share of the triangulation has " + std::to_string(number) +
                    " vertices, more than it can number: use more ranks",
                ErrorCode::kTooLarge);
  }
  share_.points.push_back(point.position);
  share_.names.push_back(point.name);
}

template <int D>
std::vector<RankIndex> GrowingShare<D>::expose(const BoxTree<D>& others) {
  std::vector<std::uint8_t> exposed(open_.size());
  const std::array trees = {&others};
  find_exposed<D, BoxTree<D>>(open_, share_.points, trees,
                              [&exposed](std::size_t s) { exposed[s] = 1; });
  std::vector<RankIndex> names;
  std::size_t kept = 0;
  apart_.clear();
  for (std::size_t s = 0; s < open_.size(); ++s) {
    if (exposed[s] == 0) {
      open_[kept++] = open_[s];
      continue;
    }
    apart_.push_back(open_[s]);
    for (const VertexId v : open_[s]) {
      if (v != kInfiniteVertex) names.push_back(share_.names[v]);
    }
  }
  open_.resize(kept);
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

template <int D>
void GrowingShare<D>::accept(const ItemsByRank<NamedSimplex<D>>& simplices,
                             const ItemsByRank<NamedPoint<D>>& points, int middle,
                             const std::array<bool, 2>& open) {
  for (const auto& [sender, some] : points) {
    for (const NamedPoint<D>& point : some) add_vertex(point);
  }
  // Acceptance wants the vertices of the lower side before those of the other one.
  std::vector<VertexId> by_side;
  const auto is_low = [&](VertexId v) { return static_cast<int>(share_.names[v].rank) < middle; };
  for (const bool low : {true, false}) {
    for (VertexId v = 0; v < share_.points.size(); ++v) {
      if (is_low(v) == low) by_side.push_back(v);
    }
  }
  const auto low_end = std::ranges::partition_point(by_side, is_low) - by_side.begin();
  std::vector<VertexId> number(by_side.size());
  for (VertexId n = 0; n < by_side.size(); ++n) number[by_side[n]] = n;
  const auto renumbered = [](Corners corners, const std::vector<VertexId>& numbers) {
    for (VertexId& v : corners) v = v == kInfiniteVertex ? v : numbers[v];
    return corners;
  };
  for (Corners& corners : apart_) corners = renumbered(corners, number);
  const std::array ends = {static_cast<VertexId>(low_end), static_cast<VertexId>(by_side.size())};
  const Acceptance<D> acceptance(ends, {open[0], open[1]}, apart_);
  typename Acceptance<D>::template Questions<> questions(acceptance);
  const auto found = [&](const Corners& corners, std::monostate, std::uint32_t) {
    open_.push_back(renumbered(corners, by_side));
  };
  for (const auto& [sender, some] : simplices) {
    for (const NamedSimplex<D>& named : some) {
      Corners corners;
      std::ranges::transform(named, corners.begin(),
                             [this](RankIndex name) { return vertex_named(name); });
      if (questions.is_new(renumbered(corners, number), {}, found)) open_.push_back(corners);
    }
  }
  questions.answer(found);
  apart_.clear();
}

template <int D>
void GrowingShare<D>::settle(std::span<const BoxTree<D>* const> outside) {
  std::vector<std::uint8_t> exposed(open_.size());
  find_exposed<D, BoxTree<D>>(open_, share_.points, outside,
                              [&exposed](std::size_t s) { exposed[s] = 1; });
  std::size_t kept = 0;
  for (std::size_t s = 0; s < open_.size(); ++s) {
    if (exposed[s] != 0) {
      open_[kept++] = open_[s];
    } else {
      share_.simplices.push_back(open_[s]);
    }
  }
  open_.resize(kept);
}

template <int D>
Share<D> GrowingShare<D>::take() {
  share_.simplices.insert(share_.simplices.end(), open_.begin(), open_.end());
  std::vector<bool> used(share_.points.size());
  for (const Corners& corners : share_.simplices) {
    for (const VertexId v : corners) {
      if (v != kInfiniteVertex) used[v] = true;
    }
  }
  std::vector<VertexId> number(share_.points.size());
  auto vertices = static_cast<VertexId>(share_.own);
  for (VertexId v = 0; v < share_.points.size(); ++v) {
    const bool is_own = v < share_.own;
    if (!is_own && !used[v]) continue;
    number[v] = is_own ? v : vertices++;
    share_.points[number[v]] = share_.points[v];
    share_.names[number[v]] = share_.names[v];
  }
  share_.points.resize(vertices);
  share_.names.resize(vertices);
  for (Corners& corners : share_.simplices) {
    for (VertexId& v : corners) v = v == kInfiniteVertex ? v : number[v];
  }
  return std::move(share_);
}

template class GrowingShare<2>;
template class GrowingShare<3>;

}  // namespace spillway::detail::distributed

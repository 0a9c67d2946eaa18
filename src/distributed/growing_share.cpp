#include "src/distributed/growing_share.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/delaunay/border/acceptance.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"

namespace spillway::distributed {
namespace {

std::uint64_t key(RankIndex name) { return (std::uint64_t{name.rank} << 32U) | name.index; }

}  // namespace

template <int D>
GrowingShare<D>::GrowingShare(int rank, std::vector<Point<D>> points,
                              std::vector<Corners> simplices, int dimension)
    : rank_(rank),
      own_(static_cast<VertexId>(points.size())),
      dimension_(dimension),
      points_(std::move(points)),
      simplices_(std::move(simplices)) {
  names_.reserve(own_);
  for (VertexId v = 0; v < own_; ++v) names_.push_back({static_cast<std::uint32_t>(rank), v});
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
void GrowingShare<D>::add_point(const NamedPoint<D>& point) {
  const auto number = static_cast<VertexId>(points_.size());
  if (!foreign_.emplace(key(point.name), number).second) return;
  if (number >= kMaxVertices) {
    throw Failure("one rank's share of the triangulation has " + std::to_string(number) +
                      " vertices, more than it can number: use more ranks",
                  ErrorCode::kTooLarge);
  }
  points_.push_back(point.position);
  names_.push_back(point.name);
}

template <int D>
std::vector<RankIndex> GrowingShare<D>::put_apart(unsigned merge) {
  std::vector<std::uint8_t> used(points_.size());
  std::size_t kept = 0;
  apart_.clear();
  for (std::size_t s = 0; s < simplices_.size(); ++s) {
    if ((exposure_[s] >> merge & 1U) == 0) {
      simplices_[kept] = simplices_[s];
      exposure_[kept++] = exposure_[s];
      continue;
    }
    apart_.push_back(simplices_[s]);
    for (const VertexId v : simplices_[s]) {
      if (v != kInfiniteVertex) used[v] = 1;
    }
  }
  simplices_.resize(kept);
  exposure_.resize(kept);
  std::vector<RankIndex> names;
  for (VertexId v = 0; v < used.size(); ++v) {
    if (used[v] != 0) names.push_back(names_[v]);
  }
  std::ranges::sort(names);
  return names;
}

template <int D>
void GrowingShare<D>::accept(const ItemsByRank<NamedSimplex<D>>& simplices,
                             const ItemsByRank<NamedPoint<D>>& points, const Halves& halves) {
  for (const auto& [sender, some] : points) {
    for (const NamedPoint<D>& point : some) add_point(point);
  }
  // Acceptance wants the vertices of the lower side before those of the other one.
  std::vector<VertexId> by_side;
  const auto is_low = [&](VertexId v) { return static_cast<int>(names_[v].rank) < halves.middle; };
  for (const bool low : {true, false}) {
    for (VertexId v = 0; v < points_.size(); ++v) {
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
  const Acceptance<D> acceptance(ends, {halves.open[0], halves.open[1]}, apart_);
  typename Acceptance<D>::template Questions<> questions(acceptance);
  const auto found = [&](const Corners& corners, std::monostate, std::uint32_t) {
    simplices_.push_back(renumbered(corners, by_side));
  };
  for (const auto& [sender, some] : simplices) {
    for (const NamedSimplex<D>& named : some) {
      Corners corners;
      std::ranges::transform(named, corners.begin(),
                             [this](RankIndex name) { return vertex_named(name); });
      if (questions.is_new(renumbered(corners, number), {}, found)) simplices_.push_back(corners);
    }
  }
  questions.answer(found);
  apart_ = {};
}

template <int D>
std::vector<std::array<VertexId, D + 1>> GrowingShare<D>::settle(
    std::span<const std::uint32_t> exposure) {
  std::vector<Corners> settled;
  const std::size_t first = exposure_.size();
  for (std::size_t s = 0; s < exposure.size(); ++s) {
    if (exposure[s] != 0) {
      simplices_[exposure_.size()] = simplices_[first + s];
      exposure_.push_back(exposure[s]);
    } else {
      settled.push_back(simplices_[first + s]);
    }
  }
  simplices_.resize(exposure_.size());
  return settled;
}

template <int D>
void GrowingShare<D>::drop_unused_points() {
  std::vector<std::uint8_t> used(points_.size());
  for (const Corners& corners : simplices_) {
    for (const VertexId v : corners) {
      if (v != kInfiniteVertex) used[v] = 1;
    }
  }
  std::vector<VertexId> number(points_.size());
  VertexId next = own_;
  foreign_.clear();
  for (VertexId v = 0; v < points_.size(); ++v) {
    number[v] = v < own_ ? v : next;
    if (v < own_ || used[v] == 0) continue;
    points_[next] = points_[v];
    names_[next] = names_[v];
    foreign_.emplace(key(names_[next]), next);
    ++next;
  }
  points_.resize(next);
  names_.resize(next);
  for (Corners& corners : simplices_) {
    for (VertexId& v : corners) v = v == kInfiniteVertex ? v : number[v];
  }
}

template <int D>
std::uint64_t GrowingShare<D>::bytes() const {
  constexpr std::uint64_t kForeignBytes = 48;  // of the table of names
  return points_.size() * (sizeof(Point<D>) + sizeof(RankIndex)) +
         simplices_.size() * (sizeof(Corners) + sizeof(exposure_[0])) +
         (points_.size() - own_) * kForeignBytes;
}

#define SPILLWAY_INSTANTIATE(D) template class GrowingShare<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::distributed

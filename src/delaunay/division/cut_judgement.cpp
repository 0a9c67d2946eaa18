#include "src/delaunay/division/cut_judgement.h"

#include <algorithm>
#include <numeric>

#include "src/delaunay/base_case/base_case.h"
#include "src/delaunay/kernel_common/hilbert_order.h"
#include "src/geometry/dimensions.h"

namespace spillway::delaunay {
namespace {

/// Another cut must cost less than this part of the one that is preferred.
constexpr double kBetter = 0.75;

template <int D>
std::vector<Point<D>> in_hilbert_order(const std::vector<Point<D>>& points) {
  Box<D> box;
  for (const Point<D>& p : points) box.expand(p);
  std::vector<Point<D>> ordered;
  for (const VertexId v : hilbert_order<D>(points, box)) ordered.push_back(points[v]);
  return ordered;
}

/// The weights of the points that have simplices across a cut, by the number of points below it;
/// `all` where there is no such cut.
template <int D>
std::vector<double> crossing_on(int axis, double all, std::span<const Point<D>> points,
                                std::span<const double> weights,
                                std::span<const std::array<VertexId, D + 1>> simplices) {
  const std::size_t count = points.size();
  std::vector<double> sorted(count);
  std::transform(points.begin(), points.end(), sorted.begin(),
                 [axis](const Point<D>& p) { return p[axis]; });
  std::sort(sorted.begin(), sorted.end());
  // Of each point, how many lie lower; then the lowest and highest of its neighbours likewise.
  std::vector<std::size_t> rank(count);
  std::transform(points.begin(), points.end(), rank.begin(), [&](const Point<D>& p) {
    return std::lower_bound(sorted.begin(), sorted.end(), p[axis]) - sorted.begin();
  });
  std::vector<std::size_t> lowest = rank;
  std::vector<std::size_t> highest = rank;
  for (const auto& corners : simplices) {
    const auto of_rank = [&](VertexId v) { return rank[v]; };
    const std::size_t least = rank[std::ranges::min(corners, {}, of_rank)];
    const std::size_t most = rank[std::ranges::max(corners, {}, of_rank)];
    for (const VertexId v : corners) {
      lowest[v] = std::min(lowest[v], least);
      highest[v] = std::max(highest[v], most);
    }
  }
  std::vector<double> steps(count + 1);
  for (std::size_t v = 0; v < count; ++v) {
    steps[lowest[v] + 1] += weights[v];
    steps[highest[v] + 1] -= weights[v];
  }
  std::partial_sum(steps.begin(), steps.end(), steps.begin());
  steps.pop_back();
  for (std::size_t below = 0; below < count; ++below) {
    if (below == 0 || sorted[below - 1] == sorted[below]) {
      steps[below] = all;
    }
  }
  return steps;
}

}  // namespace

template <int D>
CutJudgement<D>::CutJudgement(const std::vector<Point<D>>& sample) {
  const std::vector<Point<D>> points = in_hilbert_order<D>(sample);
  std::vector<VertexId> index(points.size());
  std::iota(index.begin(), index.end(), VertexId{0});
  const BaseCase<D> mesh = triangulate_base_case<D>({.points = points, .input_index = index});
  if (mesh.dimension < D) return;
  std::vector<std::array<VertexId, D + 1>> simplices;
  for (const Simplex<D>& simplex : mesh.simplices) {
    if (!simplex.infinite()) simplices.push_back(simplex.vertices);
  }
  count_crossing(points, std::vector<double>(points.size(), 1.0), simplices);
}

template <int D>
CutJudgement<D>::CutJudgement(std::span<const Point<D>> points, std::span<const double> weights,
                              std::span<const std::array<VertexId, D + 1>> simplices) {
  if (!simplices.empty()) count_crossing(points, weights, simplices);
}

template <int D>
void CutJudgement<D>::count_crossing(std::span<const Point<D>> points,
                                     std::span<const double> weights,
                                     std::span<const std::array<VertexId, D + 1>> simplices) {
  known_ = true;
  all_ = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (int k = 0; k < D; ++k) {
    crossing_[k] = crossing_on<D>(k, all_, points, weights, simplices);
  }
}

template <int D>
JudgedCut CutJudgement<D>::best_cut(int axis, std::size_t below, std::size_t room) const {
  const std::size_t count = crossing_[axis].size();
  below = std::clamp<std::size_t>(below, 1, count - 1);
  const JudgedCut preferred{axis, below, share(axis, below)};
  JudgedCut best = preferred;
  const std::size_t most = std::min({room, below - 1, count - 1 - below});
  for (int k = 0; k < D; ++k) {
    for (std::size_t step = 0; step <= 2 * most; ++step) {
      // From the middle of the room outwards, so that the nearest one of equals is found.
      const std::size_t b = step % 2 == 0 ? below + step / 2 : below - (step + 1) / 2;
      if (share(k, b) < best.share) best = {k, b, share(k, b)};
    }
  }
  return best.share < kBetter * preferred.share ? best : preferred;
}

template <int D>
bool CutJudgement<D>::some_cut_pays() const {
  constexpr std::size_t kRoomShare = 8;
  const std::size_t count = crossing_[0].size();
  return best_cut(0, count / 2, count / kRoomShare).share <= kLargestCrossing;
}

#define SPILLWAY_INSTANTIATE(D) template class CutJudgement<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay

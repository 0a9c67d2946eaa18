#include "src/distributed/halving.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "src/delaunay/common/hash.h"
#include "src/distributed/items.h"
#include "src/geometry/box.h"
#include "src/geometry/dimensions.h"

namespace spillway::distributed {
namespace {

/// Cuts by so large a sample are within half a percent of the wanted share, by rank, so that ten of
/// them in a row still balance well.
constexpr std::uint64_t kSampleSize = 1 << 14;

/// Where this rank's items are in the sequence of those of all ranks.
struct Stretch {
  std::uint64_t begin = 0;
  std::uint64_t whole = 0;
};

template <std::size_t N>
std::array<Stretch, N> stretches(const std::array<std::uint64_t, N>& counts, const Ranks& group) {
  std::array<Stretch, N> result;
  const auto all = gather_item(group, counts);
  for (int rank = 0; rank < group.size(); ++rank) {
    for (std::size_t i = 0; i < N; ++i) {
      if (rank < group.rank()) result[i].begin += all[rank][i];
      result[i].whole += all[rank][i];
    }
  }
  return result;
}

/// The least coordinate of all points.
template <int D>
double least_of_all(const std::vector<NamedPoint<D>>& points, int axis, const Ranks& group) {
  Box<D> box;
  for (const auto& point : points) box.expand(point.position);
  double least = box.lo[axis];
  group.reduce(std::span(&least, 1), Reduction::kLeast);
  return least;
}

/// Every so many points one, the same at all ranks.
template <int D>
std::vector<Point<D>> sample_of_all(const std::vector<NamedPoint<D>>& points,
                                    const Stretch& stretch, const Ranks& group) {
  const std::uint64_t stride = std::max<std::uint64_t>(1, stretch.whole / kSampleSize);
  std::vector<Point<D>> own;
  for (std::uint64_t i = stretch.begin / stride; i * stride < stretch.begin + points.size(); ++i) {
    const std::uint64_t number = i * stride + mix64(i) % stride;
    if (number < stretch.begin || number >= stretch.begin + points.size()) continue;
    own.push_back(points[number - stretch.begin].position);
  }
  std::vector<Point<D>> sample;
  for (const auto& bytes : group.gather(std::as_bytes(std::span(own)))) {
    const std::vector<Point<D>> some = items_of<Point<D>>(bytes);
    sample.insert(sample.end(), some.begin(), some.end());
  }
  return sample;
}

/// The coordinate below which the share of a sample is.
template <int D>
double value_at(std::vector<Point<D>>& sample, int axis, double share) {
  const auto place =
      sample.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sample.size() - 1));
  std::ranges::nth_element(sample, place, {}, [axis](const Point<D>& p) { return p[axis]; });
  return (*place)[axis];
}

/// The axis along which most of the points lie farthest apart. A border is a thin layer of points
/// and some far from it, which shall not have it cut along the layer: the halves would be all
/// border.
template <int D>
int axis_of_most(std::vector<Point<D>>& sample) {
  constexpr double kFar = 0.1;
  int longest = 0;
  double most = -1;
  for (int axis = 0; axis < D; ++axis) {
    const double length = value_at<D>(sample, axis, 1 - kFar) - value_at<D>(sample, axis, kFar);
    if (length > most) {
      most = length;
      longest = axis;
    }
  }
  return longest;
}

}  // namespace

template <int D>
std::vector<NamedPoint<D>> move_to_half(std::vector<NamedPoint<D>> points, const Ranks& group,
                                        int low_ranks, const ItemLimits& limits) {
  const auto [all] = stretches<1>({points.size()}, group);
  if (all.whole == 0) return points;
  std::vector<Point<D>> sample = sample_of_all(points, all, group);
  const int axis = axis_of_most<D>(sample);
  const double value = value_at<D>(sample, axis, static_cast<double>(low_ranks) / group.size());
  const double least = least_of_all(points, axis, group);
  // Points on the cut go up, unless nothing is below it.
  const auto is_high = [&, nothing_below = value <= least](const NamedPoint<D>& point) {
    return nothing_below ? point.position[axis] > value : point.position[axis] >= value;
  };

  std::array<std::uint64_t, 2> counts{};
  for (const auto& point : points) ++counts[is_high(point)];
  auto halves = stretches(counts, group);
  const std::array<std::uint64_t, 2> first_rank{0, static_cast<std::uint64_t>(low_ranks)};
  const std::array<std::uint64_t, 2> ranks{first_rank[1], group.size() - first_rank[1]};
  ItemsByRank<NamedPoint<D>> moving;
  for (const auto& point : points) {
    const bool high = is_high(point);
    const std::uint64_t to = halves[high].begin++ * ranks[high] / halves[high].whole;
    moving[static_cast<int>(first_rank[high] + to)].push_back(point);
  }
  points = {};
  for (const auto& [rank, some] : exchange_items(group, std::move(moving), limits)) {
    points.insert(points.end(), some.begin(), some.end());
  }
  return points;
}

#define SPILLWAY_INSTANTIATE(D)                                                                   \
  template std::vector<NamedPoint<D>> move_to_half(std::vector<NamedPoint<D>>, const Ranks&, int, \
                                                   const ItemLimits&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::distributed

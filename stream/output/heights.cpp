#include "stream/output/heights.h"

#include <algorithm>
#include <utility>

#include "stream/points/mean_height.h"

namespace spillway::stream {
namespace {

using Height = std::pair<double, std::uint64_t>;  // z and place in the order of the input

/// Where a point stands in the input.
std::uint64_t rank_of(VertexId place, std::span<const std::uint64_t> order) {
  return order.empty() ? place : order[place];
}

/// `sign` is 1 for the lowest, -1 for the highest.
void take_extreme(std::span<const DroppedDuplicate> duplicates, double sign,
                  std::span<VertexId> input_index, std::span<const double> heights,
                  std::span<const std::uint64_t> order) {
  for (const DroppedDuplicate& duplicate : duplicates) {
    VertexId& kept = input_index[duplicate.kept];
    const VertexId other = input_index[duplicate.dropped];
    if (Height(sign * heights[other], rank_of(other, order)) <
        Height(sign * heights[kept], rank_of(kept, order))) {
      kept = other;
    }
  }
}

/// Keeps the identity of the first.
void take_mean(std::span<const DroppedDuplicate> duplicates, std::span<VertexId> input_index,
               std::span<double> heights, std::span<const std::uint64_t> order) {
  std::vector<DroppedDuplicate> by_vertex(duplicates.begin(), duplicates.end());
  const auto kept_before = [](const DroppedDuplicate& a, const DroppedDuplicate& b) {
    return a.kept < b.kept;
  };
  std::sort(by_vertex.begin(), by_vertex.end(), kept_before);
  MeanHeight mean;
  for (auto group = by_vertex.begin(); group != by_vertex.end();) {
    const auto end = std::upper_bound(group, by_vertex.end(), *group, kept_before);
    VertexId& kept = input_index[group->kept];
    VertexId first = kept;
    mean.add(heights[kept]);
    for (; group != end; ++group) {
      const VertexId other = input_index[group->dropped];
      mean.add(heights[other]);
      if (rank_of(other, order) < rank_of(first, order)) first = other;
    }
    kept = first;
    heights[kept] = mean.take();
  }
}

}  // namespace

void keep_first(std::span<const DroppedDuplicate> duplicates, std::span<VertexId> input_index,
                std::span<const std::uint64_t> order) {
  if (order.empty()) return;
  for (const DroppedDuplicate& duplicate : duplicates) {
    VertexId& kept = input_index[duplicate.kept];
    const VertexId other = input_index[duplicate.dropped];
    if (order[other] < order[kept]) kept = other;
  }
}

void choose_heights(std::span<const DroppedDuplicate> duplicates, Heights choice,
                    std::span<VertexId> input_index, std::span<double> heights,
                    std::span<const std::uint64_t> order) {
  switch (choice) {
    case Heights::kFirst:
      keep_first(duplicates, input_index, order);
      break;
    case Heights::kLowest:
      take_extreme(duplicates, 1, input_index, heights, order);
      break;
    case Heights::kHighest:
      take_extreme(duplicates, -1, input_index, heights, order);
      break;
    case Heights::kMean:
      take_mean(duplicates, input_index, heights, order);
      break;
  }
}

}  // namespace spillway::stream

#include "stream/heights.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace spillway {
namespace {

using Height = std::pair<double, VertexId>;  // z and input index

/// `sign` is 1 for the lowest, -1 for the highest.
void take_extreme(std::span<const Duplicate> duplicates, double sign,
                  std::span<VertexId> input_index, std::span<const double> heights) {
  for (const Duplicate& duplicate : duplicates) {
    VertexId& kept = input_index[duplicate.kept];
    const VertexId other = input_index[duplicate.dropped];
    if (Height(sign * heights[other], other) < Height(sign * heights[kept], kept)) kept = other;
  }
}

void take_mean(std::span<const Duplicate> duplicates, std::span<const VertexId> input_index,
               std::span<double> heights) {
  std::vector<Duplicate> by_vertex(duplicates.begin(), duplicates.end());
  const auto kept_before = [](const Duplicate& a, const Duplicate& b) { return a.kept < b.kept; };
  std::sort(by_vertex.begin(), by_vertex.end(), kept_before);
  std::vector<double> stack;
  for (auto group = by_vertex.begin(); group != by_vertex.end();) {
    const auto end = std::upper_bound(group, by_vertex.end(), *group, kept_before);
    double& height = heights[input_index[group->kept]];
    stack.assign(1, height);
    for (; group != end; ++group) stack.push_back(heights[input_index[group->dropped]]);
    std::sort(stack.begin(), stack.end());
    height = std::accumulate(stack.begin(), stack.end(), 0.0) / static_cast<double>(stack.size());
  }
}

}  // namespace

const std::vector<std::string>& height_choice_names() {
  static const std::vector<std::string> names = {"first", "lowest", "highest", "mean"};
  return names;
}

HeightChoice height_choice_by_name(const std::string& name) {
  const auto& names = height_choice_names();
  return static_cast<HeightChoice>(std::find(names.begin(), names.end(), name) - names.begin());
}

void choose_heights(std::span<const Duplicate> duplicates, HeightChoice choice,
                    std::span<VertexId> input_index, std::span<double> heights) {
  switch (choice) {
    case HeightChoice::kFirst:
      break;  // a base case keeps the first of equal points
    case HeightChoice::kLowest:
      take_extreme(duplicates, 1, input_index, heights);
      break;
    case HeightChoice::kHighest:
      take_extreme(duplicates, -1, input_index, heights);
      break;
    case HeightChoice::kMean:
      take_mean(duplicates, input_index, heights);
      break;
  }
}

}  // namespace spillway

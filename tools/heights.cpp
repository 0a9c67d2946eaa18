#include "tools/heights.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace spillway {
namespace {

using Height = std::pair<double, VertexId>;  // z and input index

void take_lowest(Triangulation<2>& t, const std::vector<double>& heights) {
  for (const Duplicate& duplicate : t.duplicates) {
    VertexId& kept = t.input_index[duplicate.kept];
    const VertexId other = t.input_index[duplicate.dropped];
    if (Height(heights[other], other) < Height(heights[kept], kept)) kept = other;
  }
}

void take_highest(Triangulation<2>& t, const std::vector<double>& heights) {
  for (const Duplicate& duplicate : t.duplicates) {
    VertexId& kept = t.input_index[duplicate.kept];
    const VertexId other = t.input_index[duplicate.dropped];
    if (Height(-heights[other], other) < Height(-heights[kept], kept)) kept = other;
  }
}

void take_mean(const Triangulation<2>& t, std::vector<double>& heights) {
  std::vector<Duplicate> by_vertex = t.duplicates;
  const auto kept_before = [](const Duplicate& a, const Duplicate& b) { return a.kept < b.kept; };
  std::sort(by_vertex.begin(), by_vertex.end(), kept_before);
  std::vector<double> stack;
  for (auto group = by_vertex.begin(); group != by_vertex.end();) {
    const auto end = std::upper_bound(group, by_vertex.end(), *group, kept_before);
    double& height = heights[t.input_index[group->kept]];
    stack.assign(1, height);
    for (; group != end; ++group) stack.push_back(heights[t.input_index[group->dropped]]);
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

void choose_heights(Triangulation<2>& triangulation, HeightChoice choice,
                    std::vector<double>& heights) {
  switch (choice) {
    case HeightChoice::kFirst:
      break;  // the engine numbers a vertex as the first of its points
    case HeightChoice::kLowest:
      take_lowest(triangulation, heights);
      break;
    case HeightChoice::kHighest:
      take_highest(triangulation, heights);
      break;
    case HeightChoice::kMean:
      take_mean(triangulation, heights);
      break;
  }
}

}  // namespace spillway

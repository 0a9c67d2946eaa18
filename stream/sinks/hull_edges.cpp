#include "stream/sinks/hull_edges.h"

#include <algorithm>
#include <utility>

#include "src/delaunay/common/hash.h"

namespace spillway::stream {

void remove_paired(std::vector<ShortEdge>& edges) {
  std::ranges::sort(edges);
  std::size_t left = 0;
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin;
    while (end < edges.size() && edges[end].lesser == edges[begin].lesser &&
           edges[end].greater == edges[begin].greater) {
      ++end;
    }
    if ((end - begin) % 2 == 1) edges[left++] = edges[begin];
    begin = end;
  }
  edges.resize(left);
}

std::size_t HullEdges::EndsHash::operator()(const Ends& ends) const {
  return mix64(ends[0] ^ mix64(ends[1]));
}

void HullEdges::add(const HullEdge& edge) {
  ++added_since_release_;
  const auto [lesser, greater] = std::minmax(edge.from.number, edge.to.number);
  const auto [place, is_new] = open_.emplace(Ends{lesser, greater}, edge);
  if (!is_new) open_.erase(place);
}

void HullEdges::release(const std::function<bool(const Ends&)>& is_final, const Sink& sink) {
  if (added_since_release_ < open_.size()) return;
  added_since_release_ = 0;
  for (auto at = open_.begin(); at != open_.end();) {
    if (!is_final(at->first)) {
      ++at;
      continue;
    }
    sink(at->second);
    at = open_.erase(at);
  }
}

void HullEdges::finish(const Sink& sink) {
  for (const auto& [ends, edge] : std::exchange(open_, {})) sink(edge);
}

void HullEdges::number_from(std::uint64_t first) {
  for (auto& [ends, edge] : std::exchange(open_, {})) {
    HullEdge renamed = edge;
    renamed.from.number += first;
    renamed.to.number += first;
    open_.emplace(Ends{ends[0] + first, ends[1] + first}, renamed);
  }
}

}  // namespace spillway::stream

#include "stream/sinks/band_store.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace spillway::stream {
namespace {

/// Edges of all boundaries that go to the disk at a time: 4 MiB.
constexpr std::size_t kMostWaiting = (std::size_t{4} << 20) / sizeof(BoundaryEdge);

}  // namespace

BandStore::BandStore(Levels levels, ScratchFolder& scratch)
    : levels_(std::move(levels)), scratch_(scratch) {}

void BandStore::add(Boundary& boundary, const Point<2>& from, const Point<2>& to) {
  if (from == to) return;
  boundary.waiting.push_back({from, to});
  if (++waiting_ >= kMostWaiting) flush();
}

void BandStore::add_line(std::span<const Point<2>> points, std::int64_t level) {
  Boundary& boundary = lines_[level];
  for (std::size_t i = 1; i < points.size(); ++i) add(boundary, points[i - 1], points[i]);
}

void BandStore::add_hull_edge(const HullEdge& edge) {
  const Point<3>& from = edge.from.point;
  const Point<3>& to = edge.to.point;
  const bool rises = from[2] <= to[2];
  const Levels::Range range =
      rises ? levels_.between(from[2], to[2]) : levels_.between(to[2], from[2]);
  // Zeros have no sign, as in crossing points.
  Point<2> here = {from[0] + 0.0, from[1] + 0.0};
  for (std::int64_t i = range.first; i < range.end; ++i) {
    const std::int64_t level = rises ? i : range.end - 1 - (i - range.first);
    const Point<2> next = crossing_point(from, to, levels_.height(level));
    add(hull_[rises ? level - 1 : level], here, next);
    here = next;
  }
  add(hull_[rises ? range.end - 1 : range.first - 1], here, {to[0] + 0.0, to[1] + 0.0});
}

void BandStore::flush() {
  if (!file_) file_ = scratch_.create("bands");
  for (auto* const boundaries : {&lines_, &hull_}) {
    for (auto& [number, boundary] : *boundaries) {
      if (boundary.waiting.empty()) continue;
      boundary.batches.push_back({file_->size(), boundary.waiting.size()});
      file_->append(std::as_bytes(std::span(boundary.waiting)));
      boundary.waiting = {};
    }
  }
  waiting_ = 0;
}

void BandStore::append(const Boundary& boundary, bool reversed,
                       std::vector<BoundaryEdge>& edges) const {
  const std::size_t begin = edges.size();
  for (const Boundary::Batch& batch : boundary.batches) {
    const std::size_t at = edges.size();
    edges.resize(at + batch.edges);
    file_->read(batch.offset, std::as_writable_bytes(std::span(edges).subspan(at)));
  }
  edges.insert(edges.end(), boundary.waiting.begin(), boundary.waiting.end());
  if (!reversed) return;
  for (BoundaryEdge& edge : std::span(edges).subspan(begin)) std::swap(edge.from, edge.to);
}

void BandStore::finish(const Sink& sink) {
  std::set<std::int64_t> bands;
  for (const auto& [band, boundary] : hull_) bands.insert(band);
  for (const auto& [level, boundary] : lines_) bands.insert({level - 1, level});
  for (const std::int64_t band : bands) {
    std::vector<BoundaryEdge> edges;
    if (const auto found = lines_.find(band); found != lines_.end()) {
      append(found->second, false, edges);
    }
    if (const auto found = lines_.find(band + 1); found != lines_.end()) {
      append(found->second, true, edges);
    }
    if (const auto found = hull_.find(band); found != hull_.end()) {
      append(found->second, false, edges);
    }
    for (const PolygonWithHoles& polygon : polygons_of_edges(std::move(edges))) {
      sink(polygon, band);
    }
  }
}

}  // namespace spillway::stream

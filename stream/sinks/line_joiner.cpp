#include "stream/sinks/line_joiner.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "src/delaunay/common/hash.h"
#include "src/error.h"

namespace spillway::stream {
namespace {

/// Fewer points of a line than these are not worth a place on the disk.
constexpr std::size_t kLeastStored = 16;
constexpr std::size_t kPortalPoints = 3;

/// Where a ring must begin to come first in lexicographic order of its whole sequence of points:
/// at its least point, and where it visits this several times, at the visit that goes on least.
/// Two beginnings race; the one that loses rules out all that it has passed (Shiloach, "Fast
/// canonization of circular strings", 1981).
template <typename Place>
std::size_t least_beginning(std::span<const Place> ring) {
  const std::size_t size = ring.size();
  std::size_t one = 0;
  std::size_t other = 1;
  for (std::size_t equal = 0; one < size && other < size && equal < size;) {
    const auto at = [&](std::size_t begin) -> const Place& {
      const std::size_t place = begin + equal;
      return ring[place < size ? place : place - size];
    };
    if (at(one) == at(other)) {
      ++equal;
      continue;
    }
    (at(other) < at(one) ? one : other) += equal + 1;
    if (one == other) ++other;
    equal = 0;
  }
  return std::min(one, other);
}

/// Turns a closed line, whose last place is its first one again, so that it begins as it must.
template <typename Place>
void begin_at_least(std::vector<Place>& line) {
  line.pop_back();
  const auto begin = static_cast<std::ptrdiff_t>(least_beginning(std::span<const Place>(line)));
  std::rotate(line.begin(), line.begin() + begin, line.end());
  line.push_back(line.front());
}

}  // namespace

std::size_t CrossingHash::operator()(const Crossing& crossing) const {
  return mix64(crossing.edge[0] ^
               mix64(crossing.edge[1] ^ mix64(static_cast<std::uint64_t>(crossing.level))));
}

LineJoiner::LineJoiner(Sink sink, std::uint64_t memory, ScratchFolder& scratch,
                       LineTolerance tolerance)
    : sink_(std::move(sink)),
      most_points_(memory / sizeof(Point<2>)),
      scratch_(scratch),
      tolerance_(tolerance) {}

LineJoiner::Number LineJoiner::new_line() {
  if (free_.empty()) {
    open_.emplace_back();
    return static_cast<Number>(open_.size() - 1);
  }
  const Number number = free_.back();
  free_.pop_back();
  return number;
}

void LineJoiner::forget(Number number) {
  open_[number] = {};
  free_.push_back(number);
}

void LineJoiner::add(const IsoSegment& segment) {
  ++segments_since_release_;
  const auto before = ends_.find(segment.from);
  const auto behind = begins_.find(segment.to);
  if (before == ends_.end() && behind == begins_.end()) {
    begin_line(segment);
  } else if (behind == begins_.end()) {
    const Number number = before->second;
    ends_.erase(before);
    open_[number].end = segment.to;
    append_back(open_[number], segment.to_portal);
    enter(ends_, segment.to, number);
  } else if (before == ends_.end()) {
    const Number number = behind->second;
    begins_.erase(behind);
    open_[number].begin = segment.from;
    append_front(open_[number], segment.from_portal);
    enter(begins_, segment.from, number);
  } else {
    const Number first = before->second;
    const Number second = behind->second;
    ends_.erase(before);
    begins_.erase(behind);
    if (first == second) {
      append_back(open_[first], segment.to_portal);
      give_out(std::move(open_[first]));
    } else {
      join(open_[first], std::move(open_[second]));
      ends_[open_[first].end] = first;
    }
    forget(second);
  }
  if (points_in_memory_ > most_points_) spill();
}

void LineJoiner::begin_line(const IsoSegment& segment) {
  const Number number = new_line();
  Line& line = open_[number];
  line.begin = segment.from;
  line.end = segment.to;
  append_back(line, segment.from_portal);
  append_back(line, segment.to_portal);
  enter(begins_, line.begin, number);
  enter(ends_, line.end, number);
}

void LineJoiner::add(OpenLine&& part) {
  ++segments_since_release_;
  const auto before = ends_.find(part.begin);
  const auto behind = begins_.find(part.end);
  Number number = new_line();
  Line& line = open_[number];
  line.begin = part.begin;
  line.end = part.end;
  line.back = std::move(part.points);
  points_in_memory_ += line.back.size();
  if (before == ends_.end()) {
    enter(begins_, line.begin, number);
  } else {
    const Number first = before->second;
    ends_.erase(before);
    join(open_[first], std::move(line));
    forget(std::exchange(number, first));
  }
  if (behind == begins_.end()) {
    enter(ends_, part.end, number);
  } else {
    const Number second = behind->second;
    begins_.erase(behind);
    if (second == number) {
      give_out(std::move(open_[number]));
    } else {
      join(open_[number], std::move(open_[second]));
      ends_[open_[number].end] = number;
    }
    forget(second);
  }
  if (points_in_memory_ > most_points_) spill();
}

void LineJoiner::hand_over(const std::function<void(const OpenLine&)>& take) {
  for (const auto& [end, number] : ends_) {
    Line& line = open_[number];
    count_out(line);
    const Crossing begin = line.begin;
    take({.begin = begin, .end = end, .points = points_of(std::move(line))});
  }
  begins_.clear();
  ends_.clear();
  open_.clear();
  free_.clear();
}

void LineJoiner::number_from(std::uint64_t first) {
  const auto rename = [first](Crossing& crossing) {
    for (std::uint64_t& vertex : crossing.edge) vertex += first;
  };
  begins_.clear();
  for (const auto& [end, number] : std::exchange(ends_, {})) {
    Line& line = open_[number];
    rename(line.begin);
    rename(line.end);
    begins_.emplace(line.begin, number);
    ends_.emplace(line.end, number);
  }
}

void LineJoiner::append_back(Line& line, const Portal& portal) {
  if (tolerance_.sum() == 0) {
    line.back.push_back(portal.at);
    ++points_in_memory_;
  } else {
    line.back.insert(line.back.end(), {portal.at, portal.left, portal.right});
    points_in_memory_ += kPortalPoints;
  }
}

void LineJoiner::append_front(Line& line, const Portal& portal) {
  if (tolerance_.sum() == 0) {
    line.front.push_back(portal.at);
    ++points_in_memory_;
  } else {
    line.front.insert(line.front.end(), {portal.right, portal.left, portal.at});
    points_in_memory_ += kPortalPoints;
  }
}

void LineJoiner::enter(OpenEnds& ends, const Crossing& crossing, Number number) {
  if (ends.emplace(crossing, number).second) return;
  throw Failure(
      fmt::format("the triangles at the edge from vertex {} to {} do not fit together: check "
                  "the mesh",
                  crossing.edge[0], crossing.edge[1]));
}

/// Turns the points at the front into a stretch like others.
void LineJoiner::gather_front(Line& line) {
  if (line.front.empty()) return;
  std::reverse(line.front.begin(), line.front.end());
  line.middle.push_front({std::exchange(line.front, {}), 0, 0});
}

void LineJoiner::join(Line& first, Line&& second) {
  first.middle.push_back({std::exchange(first.back, {}), 0, 0});
  gather_front(second);
  if (first.middle.size() >= second.middle.size()) {
    std::move(second.middle.begin(), second.middle.end(), std::back_inserter(first.middle));
  } else {
    std::move(first.middle.rbegin(), first.middle.rend(), std::front_inserter(second.middle));
    first.middle = std::move(second.middle);
  }
  first.back = std::move(second.back);
  first.end = second.end;
}

void LineJoiner::release(const std::function<bool(const Crossing&)>& is_final) {
  if (segments_since_release_ < open_.size() - free_.size()) return;
  segments_since_release_ = 0;
  for (auto at = ends_.begin(); at != ends_.end();) {
    const Number number = at->second;
    Line& line = open_[number];
    if (!is_final(line.end) || !is_final(line.begin)) {
      ++at;
      continue;
    }
    at = ends_.erase(at);
    begins_.erase(line.begin);
    give_out(std::move(line));
    forget(number);
  }
}

void LineJoiner::finish() {
  segments_since_release_ = open_.size();
  release([](const Crossing&) { return true; });
}

void LineJoiner::store(Stretch& stretch) {
  if (stretch.points.size() < kLeastStored) return;
  if (!file_) file_ = scratch_.create("lines");
  stretch.offset = file_->size();
  stretch.stored = stretch.points.size();
  file_->append(std::as_bytes(std::span(stretch.points)));
  points_in_memory_ -= stretch.stored;
  stretch.points = {};
}

void LineJoiner::spill() {
  for (Line& line : open_) {
    gather_front(line);
    if (!line.back.empty()) line.middle.push_back({std::exchange(line.back, {}), 0, 0});
    // Small neighbours become one stretch, so that joined lines do not stay in crumbs.
    std::deque<Stretch> stretches;
    for (Stretch& stretch : line.middle) {
      if (!stretches.empty() && stretches.back().stored == 0 && stretch.stored == 0) {
        std::vector<Point<2>>& points = stretches.back().points;
        points.insert(points.end(), stretch.points.begin(), stretch.points.end());
      } else {
        stretches.push_back(std::move(stretch));
      }
    }
    for (Stretch& stretch : stretches) store(stretch);
    line.middle = std::move(stretches);
  }
  // What cannot go stays; the next time is when as much has come again.
  most_points_ = std::max(most_points_, 2 * points_in_memory_);
}

std::vector<Point<2>> LineJoiner::points_of(Line&& line) {
  gather_front(line);
  line.middle.push_back({std::move(line.back), 0, 0});
  std::vector<Point<2>> points;
  for (Stretch& stretch : line.middle) {
    if (stretch.stored > 0) {
      const std::size_t begin = points.size();
      points.resize(begin + stretch.stored);
      file_->read(stretch.offset, std::as_writable_bytes(std::span(points).subspan(begin)));
    } else {
      points.insert(points.end(), stretch.points.begin(), stretch.points.end());
    }
  }
  return points;
}

/// A line in the shape that its tolerance permits; empty if it is a single point.
std::vector<Point<2>> LineJoiner::shaped(std::span<const Point<2>> points) const {
  std::vector<Portal> portals;
  portals.reserve(points.size() / kPortalPoints);
  for (std::size_t i = 0; i < points.size(); i += kPortalPoints) {
    portals.push_back({points[i], points[i + 1], points[i + 2]});
  }
  // Parts of other joiners have a crossing in common.
  portals.erase(std::unique(portals.begin(), portals.end()), portals.end());
  const Point<2>& first = portals.front().at;
  if (std::ranges::all_of(portals, [&](const Portal& portal) { return portal.at == first; })) {
    return {};
  }
  if (portals.front() == portals.back()) begin_at_least(portals);
  return shaped_line(portals, tolerance_);
}

/// Before points_of().
void LineJoiner::count_out(const Line& line) {
  for (const Stretch& stretch : line.middle) points_in_memory_ -= stretch.points.size();
  points_in_memory_ -= line.front.size() + line.back.size();
}

void LineJoiner::give_out(Line&& line) {
  count_out(line);
  const std::int64_t level = line.begin.level;
  std::vector<Point<2>> points = points_of(std::move(line));
  if (tolerance_.sum() > 0) points = shaped(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 2) return;  // a summit just as high as the level
  if (points.front() == points.back()) begin_at_least(points);
  ++lines_;
  sink_(points, level);
}

}  // namespace spillway::stream

#include "formats/meshes/common/polygon_cutter.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "formats/meshes/common/polygon_outline.h"
#include "src/geometry/predicates.h"

namespace spillway::formats {

std::span<const PolygonCutter::Triangle> PolygonCutter::cut(std::span<const Point<2>> outline) {
  points_.assign(outline.begin(), outline.end());
  const bool reversed = !is_counterclockwise(outline);
  if (reversed) std::ranges::reverse(points_);
  triangles_.clear();
  neighbours_.clear();
  clip_ears();
  flip_edges();
  if (reversed) {
    const auto last = static_cast<std::uint32_t>(points_.size() - 1);
    for (Triangle& triangle : triangles_) {
      for (std::uint32_t& corner : triangle) corner = last - corner;
      std::swap(triangle[1], triangle[2]);
    }
  }
  return triangles_;
}

void PolygonCutter::clip_ears() {
  const auto count = static_cast<std::uint32_t>(points_.size());
  ring_.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    ring_[i] = {(i + count - 1) % count, (i + 1) % count, kNone, true};
  }
  waiting_.resize(count);
  std::iota(waiting_.rbegin(), waiting_.rend(), 0);
  std::uint32_t left = 0;  // a corner that is not clipped
  while (triangles_.size() < count - 3) {
    const std::uint32_t corner = waiting_.back();
    waiting_.pop_back();
    ring_[corner].is_waiting = false;
    if (!is_ear(corner)) continue;
    left = ring_[corner].before;
    clip(corner);
  }
  add_triangle(ring_[left].after);
  const std::uint32_t opposite = ring_[ring_[left].after].after;
  join(opposite, kClippedSide);
}

/// Whether the corner is convex and no other corner lies in the triangle that it would cut off, or
/// on its sides. Clipping another ear changes that of its two neighbours only.
bool PolygonCutter::is_ear(std::uint32_t corner) const {
  const RingCorner& at = ring_[corner];
  const Point<2>& a = points_[at.before];
  const Point<2>& b = points_[corner];
  const Point<2>& c = points_[at.after];
  if (orientation<2>({a, b, c}) <= 0) return false;
  const auto [left, right] = std::minmax({a[0], b[0], c[0]});
  const auto [low, high] = std::minmax({a[1], b[1], c[1]});
  for (std::uint32_t i = ring_[at.after].after; i != at.before; i = ring_[i].after) {
    const Point<2>& p = points_[i];
    if (p[0] < left || p[0] > right || p[1] < low || p[1] > high) continue;
    if (orientation<2>({a, b, p}) >= 0 && orientation<2>({b, c, p}) >= 0 &&
        orientation<2>({c, a, p}) >= 0) {
      return false;
    }
  }
  return true;
}

/// Cuts off the triangle at a corner. The edge that it leaves is the one opposite that corner.
void PolygonCutter::clip(std::uint32_t corner) {
  add_triangle(corner);
  const auto [before, after, behind, is_waiting] = ring_[corner];
  ring_[before].after = after;
  ring_[before].behind = static_cast<std::uint32_t>(triangles_.size() - 1);
  ring_[after].before = before;
  for (const std::uint32_t neighbour : {before, after}) {
    if (std::exchange(ring_[neighbour].is_waiting, true)) continue;
    waiting_.push_back(neighbour);
  }
}

/// Adds the triangle of a corner and its neighbours, joined to those behind its two edges.
void PolygonCutter::add_triangle(std::uint32_t corner) {
  const std::uint32_t before = ring_[corner].before;
  triangles_.push_back({before, corner, ring_[corner].after});
  neighbours_.push_back({kNone, kNone, kNone});
  join(before, 2);
  join(corner, 0);
}

/// Makes the last triangle, at its side `side`, and what is behind the edge from `corner`
/// neighbours of each other.
void PolygonCutter::join(std::uint32_t corner, std::size_t side) {
  const std::uint32_t behind = ring_[corner].behind;
  neighbours_.back()[side] = behind;
  if (behind != kNone) {
    neighbours_[behind][kClippedSide] = static_cast<std::uint32_t>(triangles_.size() - 1);
  }
}

void PolygonCutter::flip_edges() {
  waiting_.resize(triangles_.size());
  std::iota(waiting_.begin(), waiting_.end(), 0);
  while (!waiting_.empty()) {
    const std::uint32_t triangle = waiting_.back();
    waiting_.pop_back();
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t across = neighbours_[triangle][side];
      if (across == kNone || !flip_if_needed(triangle, side)) continue;
      waiting_.push_back(triangle);
      waiting_.push_back(across);
      break;
    }
  }
}

/// Flips the edge opposite corner `side` of triangle `first` if the corner beyond it lies in the
/// triangle's circle: then the two triangles make a convex quadrilateral.
bool PolygonCutter::flip_if_needed(std::uint32_t first, std::size_t side) {
  const std::uint32_t second = neighbours_[first][side];
  const std::size_t other =
      std::ranges::find(neighbours_[second], first) - neighbours_[second].begin();
  const std::uint32_t a = triangles_[first][side];
  const std::uint32_t b = triangles_[first][(side + 1) % 3];
  const std::uint32_t c = triangles_[first][(side + 2) % 3];
  const std::uint32_t d = triangles_[second][other];
  if (in_sphere<2>({points_[a], points_[b], points_[c]}, points_[d]) <= 0) return false;
  const std::uint32_t across_ab = neighbours_[first][(side + 2) % 3];
  const std::uint32_t across_ca = neighbours_[first][(side + 1) % 3];
  const std::uint32_t across_bd = neighbours_[second][(other + 1) % 3];
  const std::uint32_t across_dc = neighbours_[second][(other + 2) % 3];
  triangles_[first] = {a, b, d};
  neighbours_[first] = {across_bd, second, across_ab};
  triangles_[second] = {d, c, a};
  neighbours_[second] = {across_ca, first, across_dc};
  if (across_bd != kNone) std::ranges::replace(neighbours_[across_bd], second, first);
  if (across_ca != kNone) std::ranges::replace(neighbours_[across_ca], first, second);
  return true;
}

}  // namespace spillway::formats

#include "src/terrain/overlay_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "src/terrain/pixel_values.h"

namespace spillway::terrain {
namespace {

/// A corner of the overlay, and the height of the first surface above the second one there.
struct Corner {
  double x = 0;
  double y = 0;
  double above = 0;
};

/// A convex polygon in the plane: a triangle that was cut three times has six corners at most.
struct Polygon {
  std::array<Point<2>, 7> corners;
  std::size_t size = 0;

  void add(const Point<2>& corner) { corners[size++] = corner; }
};

double cross(const Point<2>& a, const Point<2>& b, const Point<2>& p) {
  return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/// What lies to the left of the line from `a` to `b` (Sutherland, Hodgman, "Reentrant polygon
/// clipping", 1974).
Polygon left_of(const Polygon& polygon, const Point<2>& a, const Point<2>& b) {
  Polygon left;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Point<2>& from = polygon.corners[i];
    const Point<2>& to = polygon.corners[(i + 1) % polygon.size];
    const double side = cross(a, b, from);
    const double next = cross(a, b, to);
    if (side >= 0) left.add(from);
    if ((side > 0 && next < 0) || (side < 0 && next > 0)) {
      const double share = side / (side - next);
      left.add({from[0] + (to[0] - from[0]) * share, from[1] + (to[1] - from[1]) * share});
    }
    if (left.size + 2 > left.corners.size()) break;  // by roundings alone
  }
  return left;
}

/// The triangle in coordinates that are counted from x and y of a point.
Triangle about(const Point<3>& origin, const Triangle& canonical) {
  Triangle moved = canonical;
  for (Point<3>& corner : moved) {
    corner[0] -= origin[0];
    corner[1] -= origin[1];
  }
  return moved;
}

double twice_area(const Triangle& t) {
  return (t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) - (t[1][1] - t[0][1]) * (t[2][0] - t[0][0]);
}

/// Adds a triangle of the overlay, where the difference of heights is linear. What lies above 0 of
/// a triangle with one corner above is a tetrahedron whose base is a part of it. `turned`: what is
/// above is the second surface.
void add_part(std::array<Corner, 3> part, bool turned, VolumeSums& sums) {
  const double area = std::abs((part[1].x - part[0].x) * (part[2].y - part[0].y) -
                               (part[1].y - part[0].y) * (part[2].x - part[0].x)) /
                      2;
  if (!(area > 0)) return;
  sums.area.add(area);
  ExactSum& cut = turned ? sums.fill : sums.cut;
  ExactSum& fill = turned ? sums.cut : sums.fill;
  ExactSum& cut_area = turned ? sums.fill_area : sums.cut_area;
  ExactSum& fill_area = turned ? sums.cut_area : sums.fill_area;
  std::ranges::sort(part, {}, &Corner::above);
  const double low = part[0].above;
  const double middle = part[1].above;
  const double high = part[2].above;
  const double whole = area * ((low + middle + high) / 3);
  if (low >= 0) {
    if (high == 0) return;
    cut.add(whole);
    cut_area.add(area);
    return;
  }
  if (high <= 0) {
    fill.add(-whole);
    fill_area.add(area);
    return;
  }
  // One corner is alone on its side of 0.
  const bool is_high = middle <= 0;
  const double alone = is_high ? high : low;
  const double first = is_high ? low : middle;
  const double second = is_high ? middle : high;
  const double share = alone / (alone - first) * (alone / (alone - second));
  const double small_area = area * share;
  const double small = small_area * std::abs(alone) / 3;
  const double large = std::max(0.0, small + (is_high ? -whole : whole));
  (is_high ? cut : fill).add(small);
  (is_high ? cut_area : fill_area).add(small_area);
  (is_high ? fill : cut).add(large);
  (is_high ? fill_area : cut_area).add(std::max(0.0, area - small_area));
}

}  // namespace

void VolumeSums::add(const VolumeSums& other) {
  cut.add(other.cut);
  fill.add(other.fill);
  cut_area.add(other.cut_area);
  fill_area.add(other.fill_area);
  area.add(other.area);
}

double plane_area(const Triangle& triangle) {
  return std::abs(twice_area(about(triangle[0], triangle))) / 2;
}

/// Of the two the one that comes first in lexicographic order is cut, so that they may be taken the
/// other way round.
void add_between(const Triangle& first, const Triangle& second, VolumeSums& sums) {
  const bool turned = second < first;
  const Triangle& lower = turned ? second : first;
  const Triangle a = about(lower[0], lower);
  Triangle b = about(lower[0], turned ? first : second);
  const double turn_a = twice_area(a);
  const double turn_b = twice_area(b);
  if (turn_a == 0 || turn_b == 0) return;
  const Triangle ordered_b = b;
  if (turn_b < 0) std::swap(b[1], b[2]);
  Polygon polygon;
  for (const Point<3>& corner : a) polygon.add({corner[0], corner[1]});
  if (turn_a < 0) std::swap(polygon.corners[1], polygon.corners[2]);
  for (std::size_t e = 0; e < 3 && polygon.size >= 3; ++e) {
    const Point<3>& from = b[e];
    const Point<3>& to = b[(e + 1) % 3];
    polygon = left_of(polygon, {from[0], from[1]}, {to[0], to[1]});
  }
  if (polygon.size < 3) return;
  const TrianglePlane plane_a(a, {1, 1});
  const TrianglePlane plane_b(ordered_b, {1, 1});
  std::array<Corner, 7> corners;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const auto& [x, y] = polygon.corners[i];
    corners[i] = {x, y, plane_a.inside(x, y) - plane_b.inside(x, y)};
  }
  for (std::size_t i = 2; i < polygon.size; ++i) {
    add_part({corners[0], corners[i - 1], corners[i]}, turned, sums);
  }
}

void add_above(const Triangle& triangle, double level, VolumeSums& sums) {
  const Triangle t = about(triangle[0], triangle);
  std::array<Corner, 3> part;
  for (std::size_t i = 0; i < 3; ++i) part[i] = {t[i][0], t[i][1], t[i][2] - level};
  add_part(part, false, sums);
}

}  // namespace spillway::terrain

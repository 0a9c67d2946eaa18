#include "formats/meshes/common/polygon_outline.h"

#include <algorithm>

#include "src/geometry/predicates.h"

namespace spillway::formats {
namespace {

/// One side of a polygon, with the ends of the box around it.
struct Side {
  const Point<2>& from;
  const Point<2>& to;

  [[nodiscard]] double low(int axis) const { return std::min(from[axis], to[axis]); }
  [[nodiscard]] double high(int axis) const { return std::max(from[axis], to[axis]); }
};

bool boxes_meet(const Side& a, const Side& b) {
  return a.low(0) <= b.high(0) && b.low(0) <= a.high(0) && a.low(1) <= b.high(1) &&
         b.low(1) <= a.high(1);
}

/// Whether neither point lies strictly on the side of the line where the other one is.
bool separates(const Side& line, const Point<2>& p, const Point<2>& q) {
  return orientation<2>({line.from, line.to, p}) * orientation<2>({line.from, line.to, q}) <= 0;
}

/// Of collinear sides the boxes tell all.
bool touch(const Side& a, const Side& b) {
  return boxes_meet(a, b) && separates(a, b.from, b.to) && separates(b, a.from, a.to);
}

/// Whether a side of no length begins or ends at `corner`, or both go the same way from there.
bool is_spike(const Point<2>& before, const Point<2>& corner, const Point<2>& after) {
  if (before == corner || corner == after) return true;
  return orientation<2>({before, corner, after}) == 0 && (before < corner) == (after < corner);
}

bool is_on_line(std::span<const Point<2>> outline) {
  const auto other = std::ranges::find_if(outline, [&](const auto& p) { return p != outline[0]; });
  return other == outline.end() || std::ranges::all_of(outline, [&](const Point<2>& p) {
           return orientation<2>({outline[0], *other, p}) == 0;
         });
}

bool touches_itself(std::span<const Point<2>> outline) {
  const std::size_t count = outline.size();
  const auto side = [&](std::size_t i) { return Side{outline[i], outline[(i + 1) % count]}; };
  for (std::size_t i = 0; i < count; ++i) {
    if (is_spike(outline[(i + count - 1) % count], outline[i], outline[(i + 1) % count])) {
      return true;
    }
    const std::size_t end = i == 0 ? count - 1 : count;
    for (std::size_t j = i + 2; j < end; ++j) {
      if (touch(side(i), side(j))) return true;
    }
  }
  return false;
}

}  // namespace

std::string_view outline_fault(std::span<const Point<2>> outline) {
  if (is_on_line(outline)) return "seen from above, its corners lie on one line";
  if (touches_itself(outline)) return "seen from above, its outline crosses or touches itself";
  return "";
}

bool is_counterclockwise(std::span<const Point<2>> outline) {
  // At the least corner a simple polygon makes a true turn.
  const std::size_t count = outline.size();
  const std::size_t least = std::ranges::min_element(outline) - outline.begin();
  return orientation<2>({outline[(least + count - 1) % count], outline[least],
                         outline[(least + 1) % count]}) > 0;
}

}  // namespace spillway::formats

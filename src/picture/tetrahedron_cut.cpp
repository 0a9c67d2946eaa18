#include "src/picture/tetrahedron_cut.h"

#include <utility>

namespace spillway::picture {
namespace {

Point<2> crossing(const Point<3>* a, const Point<3>* b, const Slice& plane) {
  if (*b < *a) std::swap(a, b);
  const int axis = plane.axis;
  if ((*b)[axis] == plane.value) std::swap(a, b);
  const double share = (plane.value - (*a)[axis]) / ((*b)[axis] - (*a)[axis]);
  Point<2> point{};
  for (int k = 0, i = 0; k < 3; ++k) {
    if (k != axis) point[i++] = (*a)[k] + ((*b)[k] - (*a)[k]) * share;
  }
  return point;
}

}  // namespace

PlaneCut cut(const std::array<Point<3>, 4>& tetrahedron, const Slice& plane) {
  std::array<const Point<3>*, 4> below{};
  std::array<const Point<3>*, 4> above{};
  int count_below = 0;
  int count_above = 0;
  for (const Point<3>& corner : tetrahedron) {
    if (corner[plane.axis] < plane.value) {
      below[count_below++] = &corner;
    } else {
      above[count_above++] = &corner;
    }
  }
  PlaneCut result;
  if (count_below == 2) {
    result.count = 4;
    result.corners = {crossing(below[0], above[0], plane), crossing(below[0], above[1], plane),
                      crossing(below[1], above[1], plane), crossing(below[1], above[0], plane)};
  } else if (count_below == 1 || count_above == 1) {
    result.count = 3;
    for (int i = 0; i < 3; ++i) {
      result.corners[i] = count_below == 1 ? crossing(below[0], above[i], plane)
                                           : crossing(above[0], below[i], plane);
    }
  }
  return result;
}

}  // namespace spillway::picture

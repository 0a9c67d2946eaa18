#include "src/geometry/predicates.h"

#include <algorithm>

#include "src/geometry/dimensions.h"
#include "src/geometry/predicate_stages.h"

namespace spillway::geometry {
namespace {

template <typename P>
int first_answer(const stages::Points<P>& points) {
  if (const auto answer = stages::filtered<P>(points)) return *answer;
  if (const auto answer = stages::integer<P>(points)) return *answer;
  return stages::exact<P>(points);
}

// Breaks the tie of D+2 cospherical points. The in-sphere determinant is linear in the lifted
// coordinates: a vertex's has as its coefficient the orientation of the simplex with that vertex
// replaced by the query, and the query's has minus the orientation of the simplex, which is
// positive. Since the eps^k differ by orders of magnitude, the first coefficient that is not 0
// decides.
template <int D>
int break_tie(const std::array<Point<D>, D + 1>& simplex, const Point<D>& p) {
  if (std::find(simplex.begin(), simplex.end(), p) != simplex.end()) return 0;
  std::array<int, D + 1> largest_first;
  for (int i = 0; i <= D; ++i) largest_first[i] = i;
  std::sort(largest_first.begin(), largest_first.end(),
            [&simplex](int a, int b) { return simplex[a] > simplex[b]; });
  for (const int i : largest_first) {
    if (p > simplex[i]) break;
    std::array<Point<D>, D + 1> replaced = simplex;
    replaced[i] = p;
    if (const int coefficient = first_answer<stages::Orientation<D>>(replaced)) return coefficient;
  }
  return -1;
}

}  // namespace

template <int D>
int orientation(const std::array<Point<D>, D + 1>& simplex) {
  return first_answer<stages::Orientation<D>>(simplex);
}

template <int D>
int side_of_sphere(const std::array<Point<D>, D + 1>& simplex, const Point<D>& p) {
  stages::Points<stages::InSphere<D>> points;
  std::copy(simplex.begin(), simplex.end(), points.begin());
  points[D + 1] = p;
  return first_answer<stages::InSphere<D>>(points);
}

template <int D>
int in_sphere(const std::array<Point<D>, D + 1>& simplex, const Point<D>& p) {
  const int side = side_of_sphere<D>(simplex, p);
  return side != 0 ? side : break_tie<D>(simplex, p);
}

#define SPILLWAY_INSTANTIATE(D)                                                        \
  template int orientation<D>(const std::array<Point<D>, D + 1>&);                     \
  template int side_of_sphere<D>(const std::array<Point<D>, D + 1>&, const Point<D>&); \
  template int in_sphere<D>(const std::array<Point<D>, D + 1>&, const Point<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::geometry

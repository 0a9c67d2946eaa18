#include "src/delaunay/border/conflict_region.h"

#include <optional>
#include <utility>

#include "src/geometry/dimensions.h"
#include "src/geometry/predicate_stages.h"

namespace spillway::delaunay {
namespace {

/// Whether a predicate is not known to be negative.
template <typename P>
bool may_be_positive_or_zero(const stages::Points<P>& points) {
  std::optional<int> sign = stages::filtered<P>(points);
  if (!sign) sign = stages::integer<P>(points);
  return sign.value_or(1) >= 0;
}

}  // namespace

template <int D>
ConflictRegion<D>::ConflictRegion(const std::array<VertexId, D + 1>& vertices,
                                  std::span<const Point<D>> points) {
  const auto infinite = std::find(vertices.begin(), vertices.end(), kInfiniteVertex);
  if (infinite == vertices.end()) {
    for (int i = 0; i <= D; ++i) corners_[i] = points[vertices[i]];
    ball_ = certified_ball<D>(corners_);
    return;
  }
  infinite_ = true;
  // Bring the infinite vertex to the end by an even permutation: the rest is the facet as
  // HalfSpace wants it.
  std::array<VertexId, D + 1> even = vertices;
  if (infinite != vertices.end() - 1) {
    std::swap(even[infinite - vertices.begin()], even[D]);
    std::swap(even[0], even[1]);
  }
  std::array<Point<D>, D> facet;
  for (int i = 0; i < D; ++i) facet[i] = points[even[i]];
  half_space_ = HalfSpace<D>(facet);
}

template <int D>
bool ConflictRegion<D>::may_meet(const Box<D>& box) const {
  return infinite_ ? half_space_.meets(box) : spillway::geometry::may_meet<D>(ball_, box);
}

template <int D>
bool ConflictRegion<D>::may_hold(const Point<D>& point) const {
  if (infinite_) {
    const auto place = half_space_.place_of(point);
    if (place.certain()) return place.beyond > 0;
    stages::Points<stages::Orientation<D>> points;
    std::copy(half_space_.facet().begin(), half_space_.facet().end(), points.begin());
    points[D] = point;
    return may_be_positive_or_zero<stages::Orientation<D>>(points);
  }
  if (!spillway::geometry::may_meet<D>(ball_, Box<D>{point, point})) return false;
  stages::Points<stages::InSphere<D>> points;
  std::copy(corners_.begin(), corners_.end(), points.begin());
  points[D + 1] = point;
  return may_be_positive_or_zero<stages::InSphere<D>>(points);
}

#define SPILLWAY_INSTANTIATE(D) template class ConflictRegion<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay

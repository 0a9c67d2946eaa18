#include "stream/points/point_span.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/delaunay/base_case/affine_basis.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"

namespace spillway::stream {
namespace {

template <int D>
Point<D> first_coordinates(const LatticePoint& point) {
  Point<D> first;
  std::copy_n(point.begin(), D, first.begin());
  return first;
}

}  // namespace

/// Points are compared with what is known when the block comes; what another thread finds meanwhile
/// is a part of what all points span all the same.
template <int D>
void PointSpan<D>::add(std::span<const LatticePoint> points) {
  if (full_) return;
  Facts seen;
  {
    const std::lock_guard lock(mutex_);
    seen = facts_;
  }
  for (const LatticePoint& point : points) {
    const Point<D> p = first_coordinates<D>(point);
    if (std::ranges::find(seen.points, p) != seen.points.end()) continue;
    if (is_independent<D>(seen.points, p)) {
      seen.points.push_back(p);
      if (seen.points.size() > D) break;
    } else {
      seen.others = true;
    }
  }
  add(seen);
}

template <int D>
void PointSpan<D>::add(const Facts& other) {
  const std::lock_guard lock(mutex_);
  facts_.others = facts_.others || other.others;
  for (const Point<D>& p : other.points) {
    if (facts_.points.size() > D || std::ranges::find(facts_.points, p) != facts_.points.end()) {
      continue;
    }
    if (is_independent<D>(facts_.points, p)) {
      facts_.points.push_back(p);
    } else {
      facts_.others = true;
    }
  }
  full_ = facts_.points.size() > D;
}

template <int D>
void refuse_flat_points(const PointSpan<D>& span, std::uint64_t points) {
  if (span.full()) return;
  const char* const simplex = D == 2 ? "triangle" : "tetrahedron";
  const std::size_t independent = span.facts().points.size();
  if (!span.facts().others) {
    throw Failure(fmt::format("the input has only {} distinct point{}: a {} needs {}", independent,
                              independent == 1 ? "" : "s", simplex, D + 1),
                  ErrorCode::kDegenerateInput);
  }
  throw Failure(fmt::format("all {} points lie {}: there is no {} to make", points,
                            independent == 2 ? "on one line" : "in one plane", simplex),
                ErrorCode::kDegenerateInput,
                {.remedy = independent == 3 ? Remedy::kPlane : Remedy::kNone});
}

#define SPILLWAY_INSTANTIATE(D) \
  template class PointSpan<D>;  \
  template void refuse_flat_points<D>(const PointSpan<D>&, std::uint64_t);
SPILLWAY_FOR_EACH_STREAMED_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream

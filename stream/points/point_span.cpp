#include "stream/points/point_span.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/delaunay/base_case/affine_basis.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "src/geometry/simplex_name.h"

namespace spillway::stream {
namespace {

const char* space_name(std::size_t independent) {
  if (independent == 2) return "on one line";
  return independent == 3 ? "in one plane" : "in one space of fewer dimensions";
}

}  // namespace

/// Points are compared with what is known when the block comes; what another thread finds meanwhile
/// is a part of what all points span all the same.
template <int D>
void PointSpan<D>::add(const PointsView& points) {
  if (full_) return;
  Facts seen;
  {
    const std::lock_guard lock(mutex_);
    seen = facts_;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point<D> p = points.coordinates<D>(i);
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
  const char* const simplex = simplex_of(D);
  const std::size_t independent = span.facts().points.size();
  if (!span.facts().others) {
    throw Failure(fmt::format("the input has only {} distinct point{}: a {} needs {}", independent,
                              independent == 1 ? "" : "s", simplex, D + 1),
                  ErrorCode::kDegenerateInput);
  }
  throw Failure(fmt::format("all {} points lie {}: there is no {} to make", points,
                            space_name(independent), simplex),
                ErrorCode::kDegenerateInput,
                {.remedy = D == 3 && independent == 3 ? Remedy::kPlane : Remedy::kNone});
}

#define SPILLWAY_INSTANTIATE(D) \
  template class PointSpan<D>;  \
  template void refuse_flat_points<D>(const PointSpan<D>&, std::uint64_t);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream

#include "stream/tiles/cuts/sample_mesh.h"

#include <algorithm>
#include <utility>

#include "src/delaunay/common/hash.h"
#include "src/delaunay/delaunay.h"
#include "src/geometry/dimensions.h"

namespace spillway::stream {
namespace {

/// Points that are triangulated at first, and so many times more each time.
constexpr std::size_t kFirst = 1'024;
constexpr std::size_t kMoreTimes = 8;
/// Where a point has more simplices than this, no more points are triangulated. Evenly spread ones
/// have 7 in space, those of skew lines a quarter of their number.
constexpr std::size_t kManySimplices = 16;

template <int D>
Triangulation<D> triangulate_some(std::span<const LatticePoint> sample, std::size_t most) {
  for (std::size_t count = kFirst;; count *= kMoreTimes) {
    const std::size_t wanted = std::min(count, most);
    const std::size_t step = std::max<std::size_t>(1, (sample.size() + wanted - 1) / wanted);
    std::vector<Point<D>> points;
    for (std::size_t i = 0; i < sample.size(); i += step) {
      // Not every n-th, as points may have a period.
      points.push_back(mesh_point<D>(sample[std::min(i + mix64(i) % step, sample.size() - 1)]));
    }
    Triangulation<D> mesh = delaunay_triangulation<D>(points, {.threads = 1});
    if (step == 1 || wanted == most || mesh.finite_count() > kManySimplices * points.size()) {
      return mesh;
    }
    recycle<D>(std::move(mesh));
  }
}

}  // namespace

template <int D>
Point<D> mesh_point(const LatticePoint& point) {
  Point<D> first;
  std::copy_n(point.begin(), D, first.begin());
  return first;
}

template <int D>
std::array<SampleMesh<D>, 2> SampleMesh<D>::sides(const Cut& cut) const {
  std::array<SampleMesh, 2> sides;
  std::vector<std::size_t> side_of(points.size());
  std::vector<VertexId> number(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    side_of[v] = points[v][cut.axis] >= cut.value ? 1 : 0;
    SampleMesh& side = sides[side_of[v]];
    number[v] = static_cast<VertexId>(side.points.size());
    side.points.push_back(points[v]);
    side.weights.push_back(weights[v]);
  }
  for (std::array<VertexId, D + 1> corners : simplices) {
    const std::size_t first = side_of[corners[0]];
    if (!std::ranges::all_of(corners, [&](VertexId v) { return side_of[v] == first; })) continue;
    for (VertexId& v : corners) v = number[v];
    sides[first].simplices.push_back(corners);
  }
  return sides;
}

template <int D>
SampleMesh<D> triangulate_sample(std::span<const LatticePoint> sample, std::size_t most) {
  Triangulation<D> mesh = triangulate_some<D>(sample, most);
  SampleMesh<D> result{.points = {mesh.points.begin(), mesh.points.end()},
                       .weights = std::vector<double>(mesh.points.size())};
  mesh.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
    if (simplex.infinite()) return;
    result.simplices.push_back(simplex.vertices);
    for (const VertexId v : simplex.vertices) result.weights[v] += 1;
  });
  recycle<D>(std::move(mesh));
  return result;
}

#define SPILLWAY_INSTANTIATE(D)                         \
  template Point<D> mesh_point<D>(const LatticePoint&); \
  template struct SampleMesh<D>;                        \
  template SampleMesh<D> triangulate_sample(std::span<const LatticePoint>, std::size_t);
SPILLWAY_FOR_EACH_CUT_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream

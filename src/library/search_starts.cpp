#include "src/library/search_starts.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "src/delaunay/common/hash.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"

namespace spillway::library {
namespace {

/// One point of each kSampled in the order of the input. Which one looks like chance: in an input
/// that takes turns between places, every eighth point might lie at the same one.
template <int D, class Index>
std::vector<StartPoint<D, Index>> sample_of(const MeshView<D, Index>& mesh) {
  constexpr std::size_t kStep = StartTree<D, Index>::kSampled;
  std::vector<StartPoint<D, Index>> sample;
  sample.reserve(mesh.points.size() / kStep + 1);
  for (std::size_t first = 0; first < mesh.points.size(); first += kStep) {
    const std::size_t v = first + mix64(first) % std::min(kStep, mesh.points.size() - first);
    const Index cell = mesh.vertex_cells[v];
    if (cell >= 0) sample.push_back({mesh.points[v], cell});
  }
  if (sample.empty()) {
    const Index vertex = mesh.vertex(0, 0);
    sample.push_back({mesh.points[vertex], mesh.vertex_cells[vertex]});
  }
  return sample;
}

}  // namespace

template <int D, class Index>
const StartTree<D, Index>& SearchStarts<D, Index>::of(const MeshView<D, Index>& mesh,
                                                      unsigned threads) const {
  std::call_once(
      made_, [&] { with_threads(threads, [&] { tree_ = StartTree<D, Index>(sample_of(mesh)); }); });
  return tree_;
}

#define SPILLWAY_INSTANTIATE(D)                 \
  template class SearchStarts<D, std::int32_t>; \
  template class SearchStarts<D, std::int64_t>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::library

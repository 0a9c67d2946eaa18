#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "src/delaunay/border/region_batch.h"
#include "src/geometry/point.h"
#include "src/parallel/parallel.h"

namespace spillway::detail {

/// Calls mark(s) for each simplex that a point in a leaf of one of the trees of boxes may change:
/// the border against what the trees have. Corners are positions of `points`, or kInfiniteVertex.
/// By all threads, each simplex at most once.
template <int D, typename Tree, typename Mark>
void find_exposed(std::span<const std::array<VertexId, D + 1>> simplices,
                  std::span<const Point<D>> points, std::span<const Tree* const> trees,
                  const Mark& mark) {
  constexpr std::size_t kGrain = 4096;
  parallel_for(simplices.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
    for_each_region_batch<D>(
        end - begin, [&](std::size_t s) { return simplices[begin + s]; }, points,
        [&](std::size_t first, const RegionBatch<D>& regions) {
          std::uint64_t met = 0;
          for (const Tree* tree : trees) met |= regions.may_meet_leaf(*tree, regions.all() & ~met);
          for (; met != 0; met &= met - 1) mark(begin + first + std::countr_zero(met));
        });
  });
}

}  // namespace spillway::detail

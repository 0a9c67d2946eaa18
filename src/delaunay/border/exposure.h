#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/delaunay/border/conflict_region_batch.h"
#include "src/geometry/point.h"
#include "src/parallel/parallel.h"

namespace spillway::delaunay {

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
        [&](std::size_t first, const ConflictRegionBatch<D>& regions) {
          std::uint64_t met = 0;
          for (const Tree* tree : trees) met |= regions.may_meet_leaf(*tree, regions.all() & ~met);
          for (; met != 0; met &= met - 1) mark(begin + first + std::countr_zero(met));
        });
  });
}

/// Which of the trees of boxes, as bits, have a leaf a point in which may change a simplex: of each
/// simplex, as find_exposed() takes them. Trees before `first_tree` are not asked. By all threads.
/// At most 32 trees.
template <int D, typename Tree>
std::vector<std::uint32_t> exposure_by_tree(std::span<const std::array<VertexId, D + 1>> simplices,
                                            std::span<const Point<D>> points,
                                            std::span<const Tree* const> trees,
                                            std::size_t first_tree) {
  constexpr std::size_t kGrain = 4096;
  std::vector<std::uint32_t> exposure(simplices.size());
  if (first_tree >= trees.size()) return exposure;
  parallel_for(simplices.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
    for_each_region_batch<D>(
        end - begin, [&](std::size_t s) { return simplices[begin + s]; }, points,
        [&](std::size_t first, const ConflictRegionBatch<D>& regions) {
          for (std::size_t t = first_tree; t < trees.size(); ++t) {
            std::uint64_t met = regions.may_meet_leaf(*trees[t], regions.all());
            for (; met != 0; met &= met - 1) {
              exposure[begin + first + std::countr_zero(met)] |= std::uint32_t{1} << t;
            }
          }
        });
  });
  return exposure;
}

}  // namespace spillway::delaunay

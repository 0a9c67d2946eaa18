#include "src/library/cell_numbers.h"

#include <algorithm>
#include <utility>

#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"

namespace spillway::library {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 10;  // chunks

/// The vertices of removed and infinite simplices have the two highest numbers.
template <int D>
bool is_cell(const Simplex<D>& simplex) {
  return *std::max_element(simplex.vertices.begin(), simplex.vertices.end()) < kNoVertex;
}

}  // namespace

template <int D>
CellNumbers<D>::CellNumbers(const Triangulation<D>& triangulation) {
  std::size_t chunks = 0;
  for (const SimplexList<D>& list : triangulation.lists) {
    lists_.push_back(chunks);
    chunks += grain_count(list.simplices.size(), kSlots);
  }
  chunks_ = SlabArray<Chunk>(chunks);
  for (std::uint32_t l = 0; l < triangulation.lists.size(); ++l) {
    const SlabArray<Simplex<D>>& simplices = triangulation.lists[l].simplices;
    Chunk* const of_list = chunks_.data() + lists_[l];
    parallel_for(grain_count(simplices.size(), kSlots), kGrain,
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   for (std::size_t c = begin; c < end; ++c) {
                     const std::size_t first = c * kSlots;
                     const std::size_t slots = std::min(kSlots, simplices.size() - first);
                     std::uint64_t cells = 0;
                     for (std::size_t s = 0; s < slots; ++s) {
                       cells |= std::uint64_t{is_cell(simplices[first + s])} << s;
                     }
                     of_list[c] = Chunk(cells);
                   }
                 });
  }
  for (Chunk& chunk : chunks_) {
    chunk.begin_at(count_);
    count_ += chunk.count();
  }
}

#define SPILLWAY_INSTANTIATE(D) template class CellNumbers<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::library

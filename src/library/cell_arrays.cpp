#include "src/library/cell_arrays.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"

namespace spillway::library {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 16;

/// Lowers a number that other threads may be lowering, too.
template <class Index>
void lower_to(Index& number, Index value) {
  const std::atomic_ref<Index> shared(number);
  Index now = shared.load(std::memory_order_relaxed);
  while (value < now && !shared.compare_exchange_weak(now, value, std::memory_order_relaxed)) {
  }
}

template <typename T>
SlabArray<T> joined(const std::vector<std::vector<T>>& slices) {
  std::size_t size = 0;
  for (const auto& slice : slices) size += slice.size();
  SlabArray<T> all(size);
  T* next = all.begin();
  for (const auto& slice : slices) next = std::copy(slice.begin(), slice.end(), next);
  return all;
}

template <int D, class Index>
class Flattener {
 public:
  Flattener(const Triangulation<D>& triangulation, const CellNumbers<D>& numbers)
      : triangulation_(triangulation), numbers_(numbers) {
    for (std::uint32_t l = 0; l < triangulation.lists.size(); ++l) {
      const std::size_t size = triangulation.lists[l].simplices.size();
      for (std::size_t begin = 0; begin < size; begin += kGrain) {
        ranges_.push_back({l, begin, std::min(size, begin + kGrain)});
      }
    }
  }

  CellArrays<Index> flatten() && {
    arrays_.vertices = SlabArray<Index>(numbers_.count() * (D + 1));
    arrays_.neighbours = SlabArray<Index>(numbers_.count() * (D + 1));
    lowest_ = SlabArray<Index>(triangulation_.points.size(), kNone);
    hull_facets_.resize(ranges_.size());
    hull_cells_.resize(ranges_.size());
    parallel_for(ranges_.size(), 1,
                 [this](std::size_t r, std::size_t, std::size_t) { list_cells(r); });
    arrays_.hull_facets = joined(hull_facets_);
    arrays_.hull_cells = joined(hull_cells_);
    list_vertex_cells();
    return std::move(arrays_);
  }

 private:
  static constexpr Index kNone = std::numeric_limits<Index>::max();

  /// Some simplices of a list.
  struct Range {
    std::uint32_t list;
    std::size_t begin, end;
  };

  void list_cells(std::size_t r) {
    const Range& range = ranges_[r];
    const SimplexList<D>& list = triangulation_.lists[range.list];
    const auto* const own_numbers = numbers_.list(range.list);
    const VertexId* const input_index = triangulation_.input_index.data();
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const auto cell =
          static_cast<Index>(CellNumbers<D>::number(own_numbers, static_cast<std::uint32_t>(i)));
      if (cell < 0) continue;
      const Simplex<D>& simplex = list.simplices[i];
      const std::size_t first = static_cast<std::size_t>(cell) * (D + 1);
      Index* const vertices = arrays_.vertices.data() + first;
      Index* const neighbours = arrays_.neighbours.data() + first;
      for (int k = 0; k <= D; ++k) {
        const VertexId vertex = simplex.vertices[k];
        vertices[k] = static_cast<Index>(input_index[vertex]);
        lower_to(lowest_[vertex], cell);
      }
      for (int k = 0; k <= D; ++k) {
        const std::uint32_t n = simplex.neighbours[k];
        const auto number = static_cast<Index>(n < Simplex<D>::kLink
                                                   ? CellNumbers<D>::number(own_numbers, n)
                                                   : number_of(list.links[n - Simplex<D>::kLink]));
        neighbours[k] = number;
        if (number >= 0) continue;
        hull_cells_[r].push_back(cell);
        for (const int place : facet_places<D>(k)) hull_facets_[r].push_back(vertices[place]);
      }
    }
  }

  [[nodiscard]] std::int64_t number_of(SimplexId id) const {
    return CellNumbers<D>::number(numbers_.list(id.list), id.index);
  }

  /// Vertices lie near each other under the triangulation's numbers, so that the lowest cells were
  /// gathered under these; points need not under those of the input.
  void list_vertex_cells() {
    arrays_.vertex_cells = SlabArray<Index>(lowest_.size());
    parallel_for(lowest_.size(), kGrain, [this](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        arrays_.vertex_cells[triangulation_.input_index[v]] =
            lowest_[v] == kNone ? Index{-1} : lowest_[v];
      }
    });
  }

  const Triangulation<D>& triangulation_;
  const CellNumbers<D>& numbers_;
  std::vector<Range> ranges_;
  SlabArray<Index> lowest_;  ///< cell, by the triangulation's vertices; kNone for duplicates
  CellArrays<Index> arrays_;
  std::vector<std::vector<Index>> hull_facets_, hull_cells_;  ///< by range
};

}  // namespace

template <int D, class Index>
CellArrays<Index> make_cell_arrays(const Triangulation<D>& triangulation,
                                   const CellNumbers<D>& numbers) {
  return Flattener<D, Index>(triangulation, numbers).flatten();
}

#define SPILLWAY_INSTANTIATE(D)                                               \
  template CellArrays<std::int32_t> make_cell_arrays(const Triangulation<D>&, \
                                                     const CellNumbers<D>&);  \
  template CellArrays<std::int64_t> make_cell_arrays(const Triangulation<D>&, \
                                                     const CellNumbers<D>&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::library

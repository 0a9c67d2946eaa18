#include "src/library/cell_arrays.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "src/parallel/parallel.h"

namespace spillway::detail {
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
  explicit Flattener(const Triangulation<D>& triangulation) : triangulation_(triangulation) {
    std::size_t slots = 0;
    for (std::uint32_t b = 0; b < triangulation.lists.size(); ++b) {
      const std::size_t size = triangulation.lists[b].simplices.size();
      first_slots_.push_back(slots);
      for (std::size_t begin = 0; begin < size; begin += kGrain) {
        ranges_.push_back({b, begin, std::min(size, begin + kGrain), 0});
      }
      slots += size;
    }
    numbers_ = SlabArray<Index>(slots);
  }

  CellArrays<Index> flatten() && {
    number_cells();
    arrays_.vertices = SlabArray<Index>(count_ * (D + 1));
    arrays_.neighbours = SlabArray<Index>(count_ * (D + 1));
    arrays_.vertex_cells =
        SlabArray<Index>(triangulation_.points.size(), std::numeric_limits<Index>::max());
    hull_facets_.resize(ranges_.size());
    hull_cells_.resize(ranges_.size());
    for_each_range([this](std::size_t r) { list_cells(r); });
    arrays_.hull_facets = joined(hull_facets_);
    arrays_.hull_cells = joined(hull_cells_);
    for (const Duplicate& duplicate : triangulation_.duplicates) {
      arrays_.vertex_cells[triangulation_.input_index[duplicate.dropped]] = -1;
    }
    return std::move(arrays_);
  }

 private:
  /// Some simplices of a list; `first` is the number of the first finite one.
  struct Range {
    std::uint32_t list;
    std::size_t begin, end;
    std::size_t first;
  };

  template <typename Body>
  void for_each_range(const Body& body) {
    parallel_for(ranges_.size(), 1, [&](std::size_t r, std::size_t, std::size_t) { body(r); });
  }

  [[nodiscard]] const Simplex<D>& simplex_at(const Range& range, std::size_t i) const {
    return triangulation_.lists[range.list].simplices[i];
  }

  static bool is_cell(const Simplex<D>& simplex) {
    return !simplex.removed() && !simplex.infinite();
  }

  [[nodiscard]] Index& number_of(std::uint32_t list, std::size_t i) {
    return numbers_[first_slots_[list] + i];
  }

  void number_cells() {
    for_each_range([this](std::size_t r) {
      Range& range = ranges_[r];
      for (std::size_t i = range.begin; i < range.end; ++i) {
        range.first += is_cell(simplex_at(range, i)) ? 1 : 0;
      }
    });
    for (Range& range : ranges_) count_ += std::exchange(range.first, count_);
    for_each_range([this](std::size_t r) {
      const Range& range = ranges_[r];
      auto next = static_cast<Index>(range.first);
      for (std::size_t i = range.begin; i < range.end; ++i) {
        number_of(range.list, i) = is_cell(simplex_at(range, i)) ? next++ : Index{-1};
      }
    });
  }

  void list_cells(std::size_t r) {
    const Range& range = ranges_[r];
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Index cell = number_of(range.list, i);
      if (cell < 0) continue;
      const Simplex<D>& simplex = simplex_at(range, i);
      const std::size_t first = static_cast<std::size_t>(cell) * (D + 1);
      for (int k = 0; k <= D; ++k) {
        const auto vertex = static_cast<Index>(triangulation_.input_index[simplex.vertices[k]]);
        arrays_.vertices[first + k] = vertex;
        lower_to(arrays_.vertex_cells[vertex], cell);
      }
      const SimplexId id{range.list, static_cast<std::uint32_t>(i)};
      for (int k = 0; k <= D; ++k) {
        const SimplexId neighbour = triangulation_.neighbour(id, k);
        const Index number = number_of(neighbour.list, neighbour.index);
        arrays_.neighbours[first + k] = number;
        if (number >= 0) continue;
        hull_cells_[r].push_back(cell);
        for (const int place : facet_places<D>(k)) {
          hull_facets_[r].push_back(arrays_.vertices[first + place]);
        }
      }
    }
  }

  const Triangulation<D>& triangulation_;
  std::vector<std::size_t> first_slots_;  ///< by list
  std::vector<Range> ranges_;
  SlabArray<Index> numbers_;  ///< of cells, by slot; -1 for infinite and removed simplices
  std::size_t count_ = 0;
  CellArrays<Index> arrays_;
  std::vector<std::vector<Index>> hull_facets_, hull_cells_;  ///< by range
};

}  // namespace

template <int D, class Index>
CellArrays<Index> make_cell_arrays(const Triangulation<D>& triangulation) {
  return Flattener<D, Index>(triangulation).flatten();
}

template CellArrays<std::int32_t> make_cell_arrays<2>(const Triangulation<2>&);
template CellArrays<std::int32_t> make_cell_arrays<3>(const Triangulation<3>&);
template CellArrays<std::int64_t> make_cell_arrays<2>(const Triangulation<2>&);
template CellArrays<std::int64_t> make_cell_arrays<3>(const Triangulation<3>&);

}  // namespace spillway::detail

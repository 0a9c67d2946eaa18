#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "src/delaunay/common/slab_array.h"
#include "src/delaunay/common/triangulation.h"
#include "src/library/cell_numbers.h"

namespace spillway::library {

/// A triangulation as plain arrays of numbers: vertices by their place in the input, finite cells
/// alone. The members are what the functions of the same names of spillway::Delaunay return.
template <class Index>
struct CellArrays {
  SlabArray<Index> vertices;
  SlabArray<Index> neighbours;
  SlabArray<Index> hull_facets;
  SlabArray<Index> hull_cells;
  SlabArray<Index> vertex_cells;
};

template <typename T>
std::span<const T> span_of(const SlabArray<T>& array) {
  return {array.data(), array.size()};
}

/// `numbers` are those of the triangulation's cells, which an Index must be able to hold. Made by
/// the threads of with_threads().
template <int D, class Index>
CellArrays<Index> make_cell_arrays(const Triangulation<D>& triangulation,
                                   const CellNumbers<D>& numbers);

/// The places of cell vertices in the order in which they are the facet opposite the i-th, seen
/// from outside.
template <int D>
constexpr std::array<int, D> facet_places(int i) {
  std::array<int, D> places{};
  for (int j = 0, n = 0; j <= D; ++j) {
    if (j != i) places[n++] = j;
  }
  if (i % 2 == 1) std::swap(places[D - 2], places[D - 1]);
  return places;
}

}  // namespace spillway::library

#pragma once

#include <cstddef>
#include <optional>

#include "src/geometry/lattice.h"
#include "src/geometry/periodic_domain.h"

namespace spillway::stream {

/// What the output looks like.
struct OutputOptions {
  std::optional<IntegerLattice> lattice{};  ///< coordinates are on it
  std::optional<double> max_edge{};  ///< leave out simplices with a longer edge, output units
  bool input_index = false;          ///< vertices carry their index in the input
  std::size_t record_size = 0;       ///< bytes of the attributes that vertices carry
  bool imported_vertices = false;    ///< fill Settled::imported_vertices
  const PeriodicDomain* periodic = nullptr;  ///< of copies of a simplex only one comes
};

}  // namespace spillway::stream

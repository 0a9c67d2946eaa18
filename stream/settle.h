#pragma once
// What happens to the simplices of a leaf or a merge: those that no point elsewhere can change go
// into the stream, the others stay in memory as a border.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/mesh_stream.h"
#include "src/geometry/canonical_hash.h"
#include "src/geometry/lattice.h"
#include "stream/border.h"

namespace spillway {

/// What the output looks like.
struct OutputOptions {
  std::optional<Lattice> lattice;  ///< coordinates are on it
  std::optional<double> max_edge;  ///< leave out simplices with a longer edge, output units
  bool input_index = false;        ///< vertices carry their index in the input
};

/// What a leaf or a merge gives to the stream, and what it keeps.
template <int D>
struct Settled {
  MeshBlock mesh;                     ///< `imported` still empty
  std::vector<StreamPlace> imported;  ///< where the imported vertices were announced
  CanonicalHash<D> hash;              ///< of the simplices in `mesh`
  std::uint64_t final_simplices = 0;  ///< finite and infinite ones
  std::uint64_t hull_facets = 0;      ///< infinite simplices that are final
  std::uint64_t left_out = 0;         ///< finite ones that are final, but with too long an edge
  Border<D> border;
};

/// The state of a leaf or a merge when it is known which of its simplices are final.
template <int D>
struct SettleInput {
  int dimension = D;
  BlockPlace block;  ///< of the stream, that is made
  std::span<const std::array<VertexId, D + 1>> simplices;
  std::span<const std::uint8_t> is_final;  ///< by simplex
  std::span<const BorderVertex<D>> vertices;
};

/// Announces the vertices of final simplices where that has not been done yet, finalizes those that
/// no simplex of the border has, and numbers the border's anew.
template <int D>
Settled<D> settle(const SettleInput<D>& input, const OutputOptions& output);

}  // namespace spillway

#pragma once
// What happens to the simplices of a leaf or a merge: those that no point elsewhere can change go
// into the stream, the others stay in memory as a border.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "src/delaunay/common/triangulation.h"
#include "src/geometry/canonical_hash.h"
#include "stream/output/output_options.h"
#include "stream/output/stream_place.h"
#include "stream/periodic/torus_proof.h"
#include "stream/triangulate/border.h"

namespace spillway::stream {

/// What a leaf or a merge gives to the stream, and what it keeps.
template <int D>
struct Settled {
  MeshStreamBlock mesh;                         ///< `imported` still empty
  std::vector<StreamPlace> imported;            ///< where the imported vertices were announced
  std::vector<LatticePoint> imported_vertices;  ///< they themselves, like the mesh's, if asked for
  std::vector<std::uint64_t> imported_index;    ///< likewise, if vertices carry it
  std::vector<std::byte> imported_attributes;   ///< likewise
  CanonicalHash<D> hash;                        ///< of the simplices in `mesh`
  std::uint64_t final_simplices = 0;            ///< finite and infinite ones
  std::uint64_t hull_facets = 0;                ///< infinite simplices that are final
  std::uint64_t left_out = 0;  ///< finite ones that are final, but with too long an edge
  TorusProof torus;            ///< in a periodic domain
  Border<D> border;
};

/// What becomes of a simplex.
enum class Fate : std::uint8_t {
  kKept,        ///< something elsewhere may change it
  kFinal,       ///< finite, and final
  kFinalFacet,  ///< infinite, and final: the facet of the hull is
};

/// The state of a merge when it is known which of its simplices are final.
template <int D>
struct MergeToSettle {
  BlockPlace block;  ///< of the stream, that is made
  const Border<D>& merged;
  std::span<const Fate> fates;  ///< by simplex
  /// By simplex, where it is known: see Border::exposure.
  std::span<const Exposure> exposure{};

  [[nodiscard]] int dimension() const { return merged.dimension; }
  [[nodiscard]] std::size_t vertex_count() const { return merged.vertices.size(); }
  [[nodiscard]] std::size_t simplex_count() const { return merged.simplices.size(); }
  [[nodiscard]] const std::array<VertexId, D + 1>& simplex(std::size_t s) const {
    return merged.simplices[s];
  }
  [[nodiscard]] const std::array<VertexId, D + 1>& finite_simplex(std::size_t s) const {
    return merged.simplices[s];
  }
  [[nodiscard]] const std::array<VertexId, D + 1>& open_simplex(std::size_t i) const {
    return merged.simplices[i];
  }
  [[nodiscard]] const BorderVertex<D>& vertex(VertexId v) const { return merged.vertices[v]; }
  /// The bytes of its attributes, if vertices carry any.
  [[nodiscard]] const std::byte* record(VertexId v, std::size_t size) const {
    return &merged.attributes[v * size];
  }
  [[nodiscard]] const Point<D>& position(VertexId v) const { return merged.vertices[v].position; }
  void expect(VertexId /*v*/) const {}
  [[nodiscard]] StreamPlace place(VertexId v) const { return merged.vertices[v].place; }
  /// Calls visit(s, i) for all simplices whose fate may be another one than kFinal, in order, where
  /// i is its place among them.
  template <typename Visit>
  void for_each_open(const Visit& visit) const {
    for (std::size_t s = 0; s < fates.size(); ++s) visit(s, s);
  }
};

/// The state of a leaf of a tile: its kernel's simplices and the tile's points, as they are.
template <int D>
struct LeafToSettle {
  BlockPlace block;
  std::span<const std::array<VertexId, D + 1>> corners;  ///< by simplex
  VertexId first_vertex = 0;  ///< the number that its first vertex has in `corners`
  std::span<const DroppedDuplicate>
      duplicates;                       ///< vertices without simplices, by the same numbers
  std::span<const Fate> fates;          ///< by simplex
  std::span<const std::uint32_t> open;  ///< ascending; the fates of all others are kFinal
  /// Those, if they are listed by themselves; their neighbours are any simplices.
  std::span<const Simplex<D>> open_simplices;
  std::span<const Exposure> exposure;     ///< of those `open`, where it is known
  std::span<const Point<D>> points;       ///< by vertex
  std::span<const VertexId> input_index;  ///< by vertex: its place in the three that follow
  std::span<const double> heights;        ///< D = 2
  std::span<const std::uint64_t> index;   ///< the points' index in the input, or none
  std::span<const std::byte> attributes;  ///< likewise, of a record each

  [[nodiscard]] int dimension() const { return D; }
  [[nodiscard]] std::size_t vertex_count() const { return points.size(); }
  [[nodiscard]] std::size_t simplex_count() const { return corners.size(); }
  [[nodiscard]] std::array<VertexId, D + 1> simplex(std::size_t s) const {
    return from_first(corners[s]);
  }
  /// The same, if it is known to be finite.
  [[nodiscard]] std::array<VertexId, D + 1> finite_simplex(std::size_t s) const {
    std::array<VertexId, D + 1> simplex = corners[s];
    for (VertexId& v : simplex) v -= first_vertex;
    return simplex;
  }
  /// One of those that are open, by its place among them.
  [[nodiscard]] std::array<VertexId, D + 1> open_simplex(std::size_t i) const {
    return open_simplices.empty() ? simplex(open[i]) : from_first(open_simplices[i].vertices);
  }
  [[nodiscard]] std::array<VertexId, D + 1> from_first(std::array<VertexId, D + 1> simplex) const {
    for (VertexId& v : simplex) v = v == kInfiniteVertex ? v : v - first_vertex;
    return simplex;
  }
  [[nodiscard]] BorderVertex<D> vertex(VertexId v) const {
    BorderVertex<D> vertex;
    vertex.position = points[v];
    if constexpr (D == 2) vertex.height = heights[input_index[v]];
    if (!index.empty()) vertex.input_index = index[input_index[v]];
    return vertex;
  }
  [[nodiscard]] const std::byte* record(VertexId v, std::size_t size) const {
    return &attributes[input_index[v] * size];
  }
  [[nodiscard]] const Point<D>& position(VertexId v) const { return points[v]; }
  /// Fetches ahead what vertex(v) will look up far away.
  void expect(VertexId v) const {
    if (D == 2 && v < points.size()) __builtin_prefetch(&heights[input_index[v]]);
  }
  /// Nothing of a leaf is in the stream yet.
  [[nodiscard]] StreamPlace place(VertexId /*v*/) const { return {}; }
  template <typename Visit>
  void for_each_open(const Visit& visit) const {
    for (std::size_t i = 0; i < open.size(); ++i) visit(open[i], i);
  }
};

/// Announces the vertices of final simplices where that has not been done yet, finalizes those that
/// no simplex of the border has, and numbers the border's anew. `Part` is one of the two above.
template <int D, template <int> typename Part>
Settled<D> settle(const Part<D>& part, const OutputOptions& output);

}  // namespace spillway::stream

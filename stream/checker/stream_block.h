#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/stream_numbers.h"
#include "src/geometry/point.h"
#include "stream/checker/checker.h"
#include "stream/checker/fault_text.h"
#include "stream/checker/stream_coordinates.h"

namespace spillway::checker {

/// The facet opposite a simplex's i-th corner, its vertices sorted, and whether it takes an odd
/// number of swaps to sort it once it is listed so that its outside is positive. Two positive
/// simplices lie on two sides of it if one of them sees it odd and the other not.
template <int D>
struct SortedFacet {
  std::array<std::uint32_t, D> vertices;
  bool odd;

  SortedFacet(const std::uint32_t* corners, int i) : odd((D - i) % 2 == 0) {
    for (int j = 0, k = 0; j <= D; ++j) {
      if (j != i) vertices[k++] = corners[j];
    }
    for (int last = D - 1; last > 0; --last) {
      for (int j = 0; j < last; ++j) sort_pair(j, j + 1);
    }
  }

 private:
  void sort_pair(int a, int b) {
    if (vertices[a] <= vertices[b]) return;
    std::swap(vertices[a], vertices[b]);
    odd = !odd;
  }
};

/// Whether both have the same numbers: without the call that std::array makes of ==.
template <std::size_t K>
bool same_numbers(const std::array<std::uint32_t, K>& a, const std::array<std::uint32_t, K>& b) {
  std::uint32_t difference = 0;
  for (std::size_t i = 0; i < K; ++i) difference |= a[i] ^ b[i];
  return difference == 0;
}

/// What is to be done with a mesh stream.
enum class StreamTask {
  kProve,  ///< prove that it is the Delaunay triangulation of its vertices
  kCount,  ///< only compute its totals
};

/// One block of a mesh stream on its way through the proof, and what examine() finds in it. Blocks
/// do not share anything, so that many can be examined at once; objects are used again for other
/// blocks, whose size their memory has.
template <int D>
class StreamBlock {
 public:
  // Set before examine().
  MeshStreamBlock block;
  std::uint64_t first_vertex = 0;    ///< stream number of the first new vertex
  std::uint64_t first_simplex = 0;   ///< number of the first simplex
  std::vector<std::uint32_t> slots;  ///< of vertices, by short number
  std::vector<Point<D>> points;      ///< of vertices, by short number; for the predicates

  // Set by examine().
  std::vector<bool> used;      ///< by short number: whether a simplex has the vertex
  std::vector<bool> positive;  ///< by simplex: whether it is positively oriented
  /// Facets that no other simplex of the block has. The one opposite the block's n-th corner is
  /// number n.
  std::vector<std::uint32_t> open;
  std::uint64_t inner_facets = 0;    ///< facets with two positive simplices of the block
  std::uint64_t not_delaunay = 0;    ///< of these
  std::uint64_t not_positive = 0;    ///< simplices
  std::uint64_t canonical_hash = 0;  ///< of the block's simplices
  double volume = 0;                 ///< of a periodic mesh: of the block's simplices, times D!, rounded
  CheckReport found;                 ///< only its faults

  /// Hashes the simplices and matches their facets. To prove them is to test their orientation and
  /// that the facets between them are locally Delaunay; otherwise none of that is looked at.
  void examine(const StreamCoordinates<D>& coordinates, const CheckerOptions& options,
               StreamTask task);

  [[nodiscard]] std::uint64_t simplices() const { return block.corners.size() / (D + 1); }
  /// The first corner that has an offset.
  [[nodiscard]] std::size_t first_across() const {
    return block.corners.size() - block.offsets.size();
  }
  [[nodiscard]] CornerOffset offset(std::size_t corner) const {
    return corner < first_across() ? kNoOffset : block.offsets[corner - first_across()];
  }
  /// Its corners, where its offsets put them.
  [[nodiscard]] std::array<Point<D>, D + 1> simplex(std::size_t s,
                                                    const StreamCoordinates<D>& coordinates) const {
    std::array<Point<D>, D + 1> result;
    for (int i = 0; i <= D; ++i) {
      const std::size_t corner = s * (D + 1) + i;
      result[i] = points[block.corners[corner]];
      if (corner < first_across()) continue;
      for (int k = 0; k < D; ++k) {
        const int periods = periods_along(offset(corner), k);
        if (periods != 0) result[i][k] = coordinates.torus()->moved(k, result[i][k], periods);
      }
    }
    return result;
  }
  [[nodiscard]] NamedVertex<D> named(std::uint32_t vertex,
                                     const StreamCoordinates<D>& coordinates) const {
    return {StreamNumbers(first_vertex, block)[vertex], coordinates.to_output(points[vertex])};
  }
  /// The simplex in the words of faults.
  [[nodiscard]] std::string text(std::size_t s, const StreamCoordinates<D>& coordinates) const {
    std::array<NamedVertex<D>, D + 1> names;
    for (int i = 0; i <= D; ++i) names[i] = named(block.corners[s * (D + 1) + i], coordinates);
    return simplex_text<D>(first_simplex + s, names);
  }

 private:
  static constexpr std::uint32_t kNone = ~0U;
  static constexpr std::uint32_t kMatched = kNone - 1;

  // A facet in the list of those that share its smallest vertex.
  struct Link {
    std::array<std::uint32_t, D - 1> rest;  // the other vertices
    std::uint32_t next;                     // kMatched once it is in no list
  };

  void examine_simplices(const StreamCoordinates<D>& coordinates, const CheckerOptions& options,
                         StreamTask task);
  void match_facets(const StreamCoordinates<D>& coordinates, const CheckerOptions& options,
                    StreamTask task);
  void prove_facet(std::uint32_t older, std::uint32_t newer, bool two_sides,
                   const StreamCoordinates<D>& coordinates, Faults& faults,
                   const CheckerOptions& options);

  std::vector<std::uint32_t> heads_;   // by smallest vertex: its first open facet
  std::vector<Link> links_;            // by facet
  std::vector<std::uint64_t> hashes_;  // of vertices, by short number
};

}  // namespace spillway::checker

#pragma once
// An independent proof that a mesh is the Delaunay triangulation of its vertices. It shares nothing
// with the engine but the predicates: it rebuilds all adjacency from the written simplices.

#include <spillway/check.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/lattice.h"

namespace spillway::checker {

/// Ties are broken as src/geometry/predicates.h says, unless any triangulation will do.
struct CheckerOptions : CheckOptions {
  /// The integers to test on, if the mesh itself records no lattice but its input has one.
  std::optional<IntegerLattice> input_lattice{};

  // For streams only.
  unsigned threads = 1;  ///< 0: as many as the machine has
  /// If set, is told now and then how many simplices are done, and the reader's fraction_read().
  std::function<void(std::uint64_t simplices, std::optional<double> fraction)> progress{};
  /// If set, is given the output coordinates of all vertices, in the stream's order: x, y and z,
  /// and a record with those beyond.
  std::function<void(const WorldPoint& vertex, std::span<const std::byte> further)> vertex{};
};

/// Proves or refutes: every vertex number valid and every vertex used, no simplex twice, every
/// simplex positively oriented, every facet shared by exactly two simplices or on the boundary, the
/// boundary one convex surface traversed once, every inner facet locally Delaunay by exact
/// predicates. Together these make the mesh the Delaunay triangulation of its vertices (Delaunay's
/// lemma: locally Delaunay everywhere implies globally); docs/algorithm-checker.md has the
/// argument. A periodic mesh is proved as a stream of one block is. Throws Failure if the mesh's dimension is none of 2 to 6.
CheckReport check_mesh(const Mesh& mesh, const CheckerOptions& options);

/// The same proof for a mesh that flows, in memory that is proportional to its open border (the
/// vertices that are not finalized and the facets with one simplex so far). Compares the totals
/// that the stream ends with, if it has any. Throws what the reader throws.
CheckReport check_mesh_stream(MeshStreamReader& reader, const CheckerOptions& options);

/// The numbers, the hash and the peaks of that report without the proof: faults are only totals
/// other than those that the stream ends with.
CheckReport count_mesh_stream(MeshStreamReader& reader, const CheckerOptions& options);

/// The facets of one simplex only, of a periodic mesh.
std::uint64_t count_periodic_hull(const Mesh& mesh);

/// The canonical hash of any mesh, proved or not. Throws Failure if a vertex number is out of range.
std::uint64_t canonical_hash(const Mesh& mesh);

}  // namespace spillway::checker

#pragma once
// The proof that a mesh is the Delaunay triangulation of its vertices.

#include <spillway/context.h>
#include <spillway/export.h>
#include <spillway/mesh.h>
#include <spillway/point_counts.h>
#include <spillway/points.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace spillway {

struct CheckOptions {
  /// Accept any valid Delaunay triangulation: cocircular and cospherical facets may be split either
  /// way, as other programs do.
  bool any_delaunay = false;
  /// At most so many offending simplices are described.
  std::size_t most_faults = 10;
};

/// What a check found. The mesh is proved if `fault_count` is 0.
struct CheckReport {
  /// One line a property that holds, for people to read.
  std::vector<std::string> proved{};
  /// One line an offending simplex, facet or vertex, with its numbers and coordinates; the first
  /// few of them.
  std::vector<std::string> faults{};
  std::uint64_t fault_count = 0;  ///< all of them, described or not
  std::uint64_t off_lattice = 0;  ///< faults about coordinates that are off the lattice
  std::uint64_t vertices = 0;
  std::uint64_t simplices = 0;
  std::uint64_t hull_facets = 0;  ///< facets with one simplex only
  /// Of the output coordinates; 0 if a vertex number is out of range or a coordinate not finite.
  std::uint64_t canonical_hash = 0;
  bool on_lattice = false;  ///< whether the predicates ran on lattice integers
  /// The most vertices, and facets with one simplex so far, that were held at a time; 0 for meshes
  /// that are in memory as a whole.
  std::uint64_t peak_live_vertices = 0;
  std::uint64_t peak_open_facets = 0;
  PointCounts points{};  ///< of `points` of check()
  /// Faults that are none with CheckOptions::any_delaunay: facets between cocircular or cospherical
  /// vertices that are split another way than ties are broken here.
  std::uint64_t other_ties = 0;
};

/// Proves or refutes: every vertex number valid and every vertex used, no simplex twice, every
/// simplex positively oriented, every facet shared by exactly two simplices or on the boundary, the
/// boundary one convex surface traversed once, every inner facet locally Delaunay by exact
/// predicates. Together these make the mesh the Delaunay triangulation of its vertices;
/// docs/algorithm-checker.md has the argument. It shares nothing with the engine but the
/// predicates. Formats of streams are proved while they are read, in memory for their open border;
/// others are read as a whole. With `points`, opened for the mesh's dimension, also proves that the
/// vertices are the distinct points of these. Throws what the sources throw.
SPILLWAY_API CheckReport check(MeshSource& mesh, const CheckOptions& options,
                               const Context& context, PointSource* points = nullptr);

}  // namespace spillway

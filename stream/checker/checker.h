#pragma once
// An independent proof that a mesh is the Delaunay triangulation of its vertices. It shares nothing
// with the engine but the predicates: it rebuilds all adjacency from the written simplices.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/lattice.h"

namespace spillway::detail {

struct CheckOptions {
  /// Accept any valid Delaunay triangulation: cocircular and cospherical facets may be split either
  /// way. Otherwise ties must be broken as src/geometry/predicates.h says.
  bool any_delaunay = false;
  /// The integers to test on, if the mesh itself records no lattice but its input has one.
  std::optional<Lattice> input_lattice;
  /// At most this many offending simplices are described.
  std::size_t most_faults = 10;

  // For streams only.
  unsigned threads = 1;  ///< 0: as many as the machine has
  /// If set, is told now and then how many simplices are done, and the reader's fraction_read().
  std::function<void(std::uint64_t simplices, std::optional<double> fraction)> progress = nullptr;
  /// If set, is given the output coordinates of all vertices, in the stream's order.
  std::function<void(const Point<3>& vertex)> vertex = nullptr;
};

/// What a check found. The mesh is proved if `fault_count` is 0.
struct CheckReport {
  /// One line a property that holds, for people to read.
  std::vector<std::string> proved;
  /// One line an offending simplex, facet or vertex, with its numbers and coordinates; the first
  /// few of them.
  std::vector<std::string> faults;
  std::uint64_t fault_count = 0;  ///< all of them, described or not
  std::uint64_t off_lattice = 0;  ///< faults about coordinates that are off the lattice
  std::uint64_t vertices = 0;     ///< vertices of the mesh
  std::uint64_t simplices = 0;
  std::uint64_t hull_facets = 0;  ///< facets with one simplex only
  /// Of the output coordinates; 0 if a vertex number is out of range or a coordinate not finite.
  std::uint64_t canonical_hash = 0;
  bool on_lattice = false;  ///< whether the predicates ran on lattice integers
  /// The most vertices, and facets with one simplex so far, that were held at a time; 0 for meshes
  /// that are in memory as a whole.
  std::uint64_t peak_live_vertices = 0;
  std::uint64_t peak_open_facets = 0;
};

/// Proves or refutes: every vertex number valid and every vertex used, no simplex twice, every
/// simplex positively oriented, every facet shared by exactly two simplices or on the boundary, the
/// boundary one convex surface traversed once, every inner facet locally Delaunay by exact
/// predicates. Together these make the mesh the Delaunay triangulation of its vertices (Delaunay's
/// lemma: locally Delaunay everywhere implies globally); docs/algorithm-checker.md has the
/// argument. Throws Error if the mesh's dimension is neither 2 nor 3.
CheckReport check_mesh(const Mesh& mesh, const CheckOptions& options);

/// The same proof for a mesh that flows, in memory that is proportional to its open border (the
/// vertices that are not finalized and the facets with one simplex so far). Compares the totals
/// that the stream ends with, if it has any. Throws what the reader throws.
CheckReport check_mesh_stream(MeshStreamReader& reader, const CheckOptions& options);

/// The numbers, the hash and the peaks of that report without the proof: faults are only totals
/// other than those that the stream ends with.
CheckReport count_mesh_stream(MeshStreamReader& reader, const CheckOptions& options);

/// The canonical hash of any mesh, proved or not. Throws Error if a vertex number is out of range.
std::uint64_t canonical_hash(const Mesh& mesh);

}  // namespace spillway::detail

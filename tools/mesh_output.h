#pragma once
// From a triangulation in memory to a mesh file.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/file_system.h"
#include "formats/mesh_writer.h"
#include "src/delaunay/triangulation.h"
#include "src/geometry/lattice.h"
#include "tools/progress.h"

namespace spillway {

/// A triangulation and what its vertices are in the world.
template <int D>
struct TriangulatedPoints {
  Triangulation<D> triangulation;
  std::optional<Lattice> lattice;    ///< set if the triangulation is of integers
  std::vector<double> heights;       ///< D = 2: z by input index, in output coordinates
  std::vector<std::uint64_t> index;  ///< by input index: the number written with --id, or empty
  std::string crs;

  /// Output coordinates of a vertex.
  [[nodiscard]] Point<3> world(VertexId vertex) const {
    Point<3> point{};
    for (int k = 0; k < D; ++k) {
      const double coordinate = triangulation.points[vertex][k];
      point[k] = lattice ? lattice->to_world(k, coordinate) : coordinate;
    }
    if constexpr (D == 2) point[2] = heights[triangulation.input_index[vertex]];
    return point;
  }
};

/// What is counted while looking at every simplex of the output.
struct MeshFigures {
  std::uint64_t vertices = 0;
  std::uint64_t simplices = 0;
  std::uint64_t left_out = 0;     ///< simplices with an edge longer than --max-edge
  std::uint64_t hull_facets = 0;  ///< facets of one simplex only
  std::uint64_t canonical_hash = 0;
};

/// Which simplices are written: those whose edges are at most so long, in x, y (D = 3: x, y, z).
struct MeshSelection {
  std::optional<double> max_edge;
};

/// Counts and hashes what write_mesh() would write, with so many threads (0: all).
template <int D>
MeshFigures measure_mesh(const TriangulatedPoints<D>& points, const MeshSelection& selection,
                         unsigned threads);

/// Writes vertices in the order of the triangulation, duplicates skipped, then simplices in its
/// order. Vertices that only left-out simplices use are written too.
template <int D>
void write_mesh(const TriangulatedPoints<D>& points, const MeshSelection& selection,
                const MeshFigures& figures, FileSystem& files, const std::string& path,
                MeshFormat format, Progress& progress);

}  // namespace spillway

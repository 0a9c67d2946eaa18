#pragma once
// What `dem`, `contour` and `render` have in common: the triangles of a terrain, from points that
// are triangulated on the way, or from a mesh.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "src/runtime/memory_budget.h"
#include "stream/ranks/rank_pipeline.h"
#include "tools/options/triangulation_options.h"
#include "tools/report/progress.h"
#include "tools/report/statistics.h"

namespace spillway::detail {

/// The command line of such a subcommand.
struct TerrainOptions : TriangulationOptions {
  std::string mesh_format;
  int dimension = 2;        ///< in which points are triangulated: 2 or 3
  bool tetrahedra = false;  ///< whether a mesh may be of tetrahedra, too
  /// Options that tell of points elsewhere, and have a meaning of their own here.
  std::vector<std::string_view> own_options;
};

/// IN, --mesh-format and what triangulate has.
void add_terrain_options(CommandLine& app, TerrainOptions& options);

/// What is known of a terrain before its triangles come.
struct TerrainHeader {
  int dimension = 2;               ///< 3: what comes are tetrahedra
  std::optional<Lattice> lattice;  ///< of the vertices' x and y, and z unless its scale is 1
  std::string crs;
  /// A longest edge that is still to be heeded: that of a mesh, while points are triangulated
  /// without what is longer.
  std::optional<double> max_edge;
};

/// What is made of a terrain.
class TerrainUse {
 public:
  virtual ~TerrainUse() = default;

  /// Returns where the triangles are to go; it must live as long as the use.
  virtual BlockSink& begin(const TerrainHeader& header) = 0;

  /// Whether extent_known() is needed: a mesh stream has to be read twice then.
  [[nodiscard]] virtual bool wants_extent() const = 0;

  /// Whether points without z are of no use.
  [[nodiscard]] virtual bool needs_heights() const { return false; }

  /// The box around all vertices, in the coordinates in which they come, and how many these are
  /// (of points: how many points), before the first triangle. It may be empty where it is not
  /// wanted, or where tetrahedra come.
  virtual void extent_known(const Box<2>& extent, std::uint64_t vertices) = 0;

  /// Over ranks, after the last block of this rank's own tiles: what merges with others have made
  /// final here.
  virtual void add_merged(const MergedPart& /*part*/) {}
};

/// What a run works with.
struct TerrainTools {
  MemoryBudget& budget;
  ScratchFolder& scratch;
  Progress& progress;
  unsigned threads = 1;
  const distributed::Ranks* ranks = nullptr;  ///< that share the work, if there are any
};

/// Sends all triangles of the input to `use`, and counts them in `statistics`; over ranks those
/// that this rank finds, of points. Throws Error for a mesh of tetrahedra, unless the options allow
/// it, and if nothing is left.
void feed_terrain(const TerrainOptions& options, TerrainUse& use, const TerrainTools& tools,
                  RunStatistics& statistics);

}  // namespace spillway::detail

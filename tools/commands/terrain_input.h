#pragma once
// What `dem`, `contour` and `render` have in common: the triangles of a terrain, from points that
// are triangulated on the way, or from a mesh.

#include <spillway/context.h>
#include <spillway/mesh.h>

#include <string>
#include <string_view>
#include <vector>

#include "tools/options/triangulation_options.h"
#include "tools/report/progress.h"
#include "tools/report/statistics.h"

namespace spillway::command {

/// The command line of such a subcommand.
struct TerrainOptions : TriangulationOptions {
  std::string mesh_format;
  int dimension = 2;  ///< in which points are triangulated: 2 or 3
  /// Options that tell of points elsewhere, and have a meaning of their own here.
  std::vector<std::string_view> own_options;
  bool uses_crs = false;  ///< the coordinate system of a mesh makes a difference
};

/// IN, --mesh-format and what triangulate has.
void add_terrain_options(CommandLine& app, TerrainOptions& options);

/// What the run may take, and who does it.
Context terrain_context(const TerrainOptions& options, ProgressLine& progress);

/// Sends the triangles of the input to `sink`. Throws UsageError for options that the input at hand
/// does not have.
TracedReport send_terrain(const TerrainOptions& options, MeshSink& sink, const Context& context);

/// Says what was dropped of the points, and of the simplices.
void say_what_is_left_out(const TerrainOptions& options, const Report& report,
                          ProgressLine& progress);

}  // namespace spillway::command

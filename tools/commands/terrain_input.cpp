#include "tools/commands/terrain_input.h"

#include <fmt/format.h>
#include <spillway/convert.h>
#include <spillway/input.h>
#include <spillway/triangulate.h>

#include <algorithm>
#include <filesystem>

#include "formats/meshes/mesh_formats.h"
#include "src/geometry/simplex_name.h"
#include "tools/commands/run_statistics.h"
#include "tools/options/command_options.h"
#include "tools/process/rank_job.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

void refuse_options_of_points(const TerrainOptions& options) {
  std::vector<std::string_view> names(kPointOptionNames.begin(), kPointOptionNames.end());
  names.insert(names.end(), kTriangulationOptionNames.begin(), kTriangulationOptionNames.end());
  names.insert(names.end(), {"--dim", "--clip-bounds"});
  std::erase_if(names, [&](std::string_view name) {
    const bool is_of_crs = name == "--crs" || name == "--force-crs";
    if (is_of_crs && options.uses_crs && !options.input.crs.empty()) return true;
    return std::ranges::find(options.own_options, name) != options.own_options.end();
  });
  if (options.input.clips_product) {
    std::erase_if(names, [](std::string_view name) {
      return name == "--clip" || name == "--clip-buffer" || name == "--clip-outside" ||
             name == "--force-crs";
    });
  }
  refuse_given(*options.app, names, fmt::format("on {}, which is a mesh", options.inputs.front()));
}

/// Over ranks there are points only. What is none of them is said when they are opened.
void refuse_mesh(const TerrainOptions& options, const Context& context) {
  const std::string& path = options.inputs.front();
  if (!is_first_rank() || path == "-" || !std::filesystem::is_regular_file(path)) return;
  if (!options.mesh_format.empty() || kind_of_input(path, context) == InputKind::kMesh) {
    throw UsageError(path + " is a mesh, which one process reads: start it without mpirun");
  }
}

/// Whether the one input is a mesh.
bool is_mesh(const TerrainOptions& options, const Context& context) {
  if (context.options().executor != nullptr) {
    refuse_mesh(options, context);
    return false;
  }
  const std::string& path = options.inputs.front();
  const bool several = options.inputs.size() > 1 || stands_for_several(path);
  if (several) {
    refuse_given(*options.app, {"--mesh-format"}, "on several inputs, which are points");
  }
  if (!options.input.format.empty()) {
    refuse_given(*options.app, {"--mesh-format"}, "with --input-format, which is of points");
    return false;
  }
  if (several || (path != "-" && !std::filesystem::exists(path))) return false;
  return !options.mesh_format.empty() || kind_of_input(path, context) == InputKind::kMesh;
}

}  // namespace

void add_terrain_options(CommandLine& app, TerrainOptions& options) {
  app.add_option("IN", options.inputs, "Point files, as `triangulate` takes them, or one mesh")
      .required();
  add_triangulation_options(app, options);
  add_choice(app, "--mesh-format", options.mesh_format, mesh_format_names(),
             "Format of a mesh, where neither content nor name tell");
}

Context terrain_context(const TerrainOptions& options, ProgressLine& progress) {
  reuse_freed_memory();
  ContextOptions limits = context_options(options.memory, thread_count(options), progress);
  limits.executor = rank_executor();
  return Context(limits);
}

TracedReport send_terrain(const TerrainOptions& options, MeshSink& sink, const Context& context) {
  if (is_mesh(options, context)) {
    refuse_options_of_points(options);
    const auto mesh = open_mesh(options.inputs.front(),
                                mesh_options(options.input, options.mesh_format), context);
    return {convert(*mesh, sink, context)};
  }
  const auto points =
      open_points(options.inputs, point_options(options.input, options.dimension), context);
  check_heights(options, points->header());
  return triangulate_and_trace(options, *points, sink,
                               triangulate_options(options, options.dimension), context);
}

void say_what_is_left_out(const TerrainOptions& options, const Report& report,
                          ProgressLine& progress) {
  if (!report.points.all_kept()) progress.say(describe(report.points));
  if (report.left_out == 0) return;
  progress.say(fmt::format("{} {} with an edge longer than {} left out", report.left_out,
                           simplices_of(report.dimension), *max_edge(options)));
}

}  // namespace spillway::command

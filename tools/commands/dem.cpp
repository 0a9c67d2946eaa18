#include <fmt/format.h>
#include <spillway/dem.h>
#include <spillway/height.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "src/runtime/memory_budget.h"
#include "tools/commands/command.h"
#include "tools/commands/dem_options.h"
#include "tools/commands/run_statistics.h"
#include "tools/commands/skipped_inputs.h"
#include "tools/commands/tile_files.h"
#include "tools/process/rank_job.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway dem survey.laz -o dem.tif --resolution 0.5\n"
    "  spillway dem 'tiles/*.laz' -o dtm.tif --resolution 0.5 --keep-class 2 --align --cog\n"
    "  spillway dem survey.las -o relief.tif --resolution 1 --product height,slope,hillshade\n"
    "  spillway dem survey.las -o points.tif --resolution 1 --product max,mean,p95,count\n"
    "  spillway dem survey.las -o canopy.tif --resolution 1 --product chm --ground-class 2\n"
    "  spillway dem after.las -o after.tif --like before.tif\n"
    "  spillway dem 'tiles/*.laz' -o 'dtm_{x}_{y}.tif' --resolution 0.5 --tiles 1000\n"
    "  spillway triangulate survey.las -o - | spillway dem - -o dem.tif --resolution 1\n"
    "The DEM is interpolated linearly within the triangles; docs/dem.md tells more.";

DemProductTraits traits_of_band(const std::string& name) {
  return traits_of(dem_band_of(name)->product);
}

/// Why no pixel has a value, and what helps.
std::string why_empty(const DemCommandOptions& options, const DemReport& raster) {
  if (!options.compute_edges && traits_of_band(raster.bands.front()).of_neighbours &&
      (raster.columns < 3 || raster.rows < 3)) {
    return fmt::format(
        "none of the {} x {} has the eight neighbours that {} needs; give a smaller --resolution, "
        "or --compute-edges",
        raster.columns, raster.rows, raster.bands.front());
  }
  if (options.input.clips_product) {
    return fmt::format("none with its centre in a triangle lies where {} says", options.input.clip);
  }
  if (options.bounds.empty() && options.like.empty()) {
    return fmt::format(
        "pixels of {} are so large that none has its centre in a triangle of the points; give a "
        "smaller --resolution",
        raster.resolution);
  }
  const bool like = !options.like.empty();
  return fmt::format(
      "the raster of {} x {} pixels of {}, from {},{} to {},{}, lies beside the points, or its "
      "pixels are too large for them; choose another {}{}",
      raster.columns, raster.rows, raster.resolution, raster.west,
      raster.north - raster.rows * raster.resolution,
      raster.west + raster.columns * raster.resolution, raster.north, like ? "--like" : "--bounds",
      like ? "" : " or a smaller --resolution");
}

void say_tiles(const DemCommandOptions& options, const DemReport& raster, ProgressLine& progress) {
  progress.say(fmt::format(
      "{} tiles{}{}, {} of them before the end of the triangulation", raster.files,
      raster.empty_tiles == 0 ? "" : fmt::format(" and {} without data", raster.empty_tiles),
      raster.vrt.empty() ? "" : fmt::format(", put together by {}", raster.vrt),
      raster.files_during_run));
  warn_of_other_tiles(raster.other_files, options.output, progress);
}

void say(const DemCommandOptions& options, const Report& report, const DemReport& raster,
         const RunFacts& facts, ProgressLine& progress) {
  say_what_is_left_out(options, report, progress);
  if (raster.spilled_bytes > 0) {
    progress.detail(
        fmt::format("{} of pixels on the disk", memory_size_text(raster.spilled_bytes)));
  }
  if (raster.pixels_with_data == 0) {
    progress.insist("warning: no pixel has a value: " + why_empty(options, raster));
  }
  if (!options.tiles.empty()) say_tiles(options, raster, progress);
  const bool of_points = std::ranges::any_of(
      raster.bands, [](const std::string& name) { return traits_of_band(name).of_points; });
  if (of_points) {
    // Tiles may overlap.
    const std::uint64_t beside =
        report.mesh.points - std::min(report.mesh.points, raster.points_in_pixels);
    progress.say(
        fmt::format("{} points in {} pixels{}", raster.points_in_pixels, raster.pixels_with_points,
                    beside > 0 ? fmt::format(", {} beside the raster{}", beside,
                                             options.input.clips_product ? " or clipped" : "")
                               : ""));
  }
  if (options.fill_voids) {
    progress.say(fmt::format("{} pixels without points have the height of a triangle",
                             raster.filled_pixels));
  }
  const std::string of_mesh =
      report.mesh.simplices > 0
          ? fmt::format("{} vertices, {} triangles; ", report.mesh.vertices, report.mesh.simplices)
          : "";
  progress.say(fmt::format("{}{} x {} pixels of {}, {} with data, {:.2f} s", of_mesh,
                           raster.columns, raster.rows, raster.resolution, raster.pixels_with_data,
                           facts.seconds));
}

Json raster_json(const DemReport& raster) {
  return {{"columns", raster.columns},
          {"rows", raster.rows},
          {"resolution", raster.resolution},
          {"west", raster.west},
          {"north", raster.north},
          {"bands", raster.bands},
          {"pixels_with_data", raster.pixels_with_data},
          {"files", raster.files},
          {"files_during_run", raster.files_during_run},
          {"empty_tiles", raster.empty_tiles},
          {"vrt", raster.vrt},
          {"closed_tiles", raster.closed_tiles},
          {"spilled_bytes", raster.spilled_bytes},
          {"points_in_pixels", raster.points_in_pixels},
          {"pixels_with_points", raster.pixels_with_points},
          {"filled_pixels", raster.filled_pixels}};
}

/// Sends the triangles of points whose z is their height above the ground. Those below it, or
/// beside it, are left out; of equal x and y the highest counts, unless --heights says otherwise.
TracedReport send_canopy(const DemCommandOptions& options, MeshSink& sink, const Context& context,
                         ProgressLine& progress) {
  const std::vector<int> classes =
      options.ground_class.empty() ? std::vector<int>{2} : parse_classes(options.ground_class);
  TriangulateOptions how = triangulate_options(options, 2);
  TriangulateOptions of_ground = how;
  of_ground.heights = Heights::kFirst;
  of_ground.max_edge.reset();
  const PointsAboveGround above = open_above_ground(
      options.inputs, point_options(options.input, 0), classes,
      {.min_height = 0, .foreign_crs = options.input.force_crs}, of_ground, context);
  progress.say(fmt::format(
      "{} points above a ground of {} triangles; {} below it and {} over no triangle left out",
      above.report.points.written, above.report.ground.mesh.simplices, above.report.below_ground,
      above.report.without_ground));
  if (given_options(*options.app, std::array<std::string_view, 1>{"--heights"}).empty()) {
    how.heights = Heights::kHighest;
  }
  TracedReport report = triangulate_and_trace(options, *above.points, sink, how, context);
  report.points = above.report.points.points;
  report.skipped_files = above.report.points.skipped_files;
  return report;
}

int run(const DemCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const DemOptions how = dem_options(options);
  check_statistics_file(options, options.output, "the raster");
  ProgressLine progress = make_progress(options.report, options.output);
  const Context context = terrain_context(options, progress);
  const auto dem = create_dem(options.output, how, context);
  const TracedReport report = options.products == kCanopy
                                  ? send_canopy(options, *dem, context, progress)
                                  : send_terrain(options, *dem, context);
  if (!is_first_rank()) return kExitDone;
  const RunFacts facts = facts_of_run(options, options.output, context, start);
  say(options, report, dem->report(), facts, progress);
  write_statistics(options, report, facts, {{"raster", raster_json(dem->report())}});
  return tell_skipped(report.skipped_files, progress);
}

}  // namespace

Subcommand add_dem(CommandLine& root) {
  const auto options = std::make_shared<DemCommandOptions>();
  CommandLine& app = root.add_subcommand("dem", "Make a raster of heights, slopes or shades");
  app.set_footer(kExamples);
  add_dem_options(app, *options);
  return {&app, [options] { return run(*options); }, true};
}

}  // namespace spillway::command

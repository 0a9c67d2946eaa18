#include <fmt/format.h>
#include <spillway/contours.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/vectors/vector_formats.h"
#include "tools/commands/command.h"
#include "tools/commands/run_statistics.h"
#include "tools/commands/skipped_inputs.h"
#include "tools/commands/terrain_input.h"
#include "tools/commands/tile_files.h"
#include "tools/options/command_options.h"
#include "tools/process/rank_job.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway contour survey.laz -o contours.gpkg --interval 1\n"
    "  spillway contour 'tiles/*.laz' -o contours.shp --interval 5 --keep-class 2 --thin 1\n"
    "  spillway contour tin.spm -o shore.geojson --levels 0,0.5\n"
    "  spillway contour survey.laz -o bands.gpkg --interval 5 --bands\n"
    "Lines run with higher ground to their left; docs/contour.md tells more.";

struct ContourCommandOptions : TerrainOptions {
  std::string output;
  std::optional<double> interval;
  double base = 0;
  std::vector<double> levels;
  std::uint64_t index = ContourOptions().index;
  std::optional<double> min_length;
  std::optional<double> smooth;
  std::optional<double> simplify;
  bool bands = false;
  std::string tiles;
};

ContourOptions contour_options(const ContourCommandOptions& options) {
  ContourOptions contours;
  contours.levels = options.levels;
  contours.max_edge = max_edge(options);
  contours.foreign_crs = options.input.force_crs;
  contours.min_length = options.min_length;
  contours.smooth = options.smooth;
  contours.simplify = options.simplify;
  contours.bands = options.bands;
  if (options.bands) {
    refuse_given(*options.app, {"--index", "--min-length"}, "with --bands, which are no lines");
  }
  const TileChoice tiles = parse_tiles(options.tiles);
  contours.tile_side = tiles.side;
  contours.tile_polygons = tiles.polygons;
  if (options.tiles.empty()) refuse_pattern(options.output);
  if (!options.levels.empty()) {
    refuse_given(*options.app, {"--interval", "--base", "--index"},
                 "with --levels, which names all heights");
    return contours;
  }
  if (!options.interval) {
    throw UsageError("--interval, the height between two contours, is missing (or --levels)");
  }
  contours.interval = *options.interval;
  contours.base = options.base;
  contours.index = options.index;
  return contours;
}

void say(const ContourCommandOptions& options, const Report& report, const ContourReport& contours,
         const RunFacts& facts, ProgressLine& progress) {
  say_what_is_left_out(options, report, progress);
  if (contours.short_lines > 0) {
    const std::string text = fmt::format("{}{} lines left out: shorter than --min-length {}",
                                         contours.lines == 0 ? "warning: no lines: " : "",
                                         contours.short_lines, *options.min_length);
    contours.lines == 0 ? progress.insist(text) : progress.say(text);
  } else if (contours.lines == 0 && !options.bands) {
    progress.insist(
        fmt::format("warning: no lines: no level lies above the lowest height, {}, and up to the "
                    "highest, {}",
                    contours.lowest, contours.highest));
  }
  if (!options.tiles.empty()) {
    const char* const what = options.bands ? "polygons" : "lines";
    if (contours.outside_tiles > 0) {
      progress.insist(fmt::format("warning: {} {} are in none of the tiles, and in no file",
                                  contours.outside_tiles, what));
    }
    progress.say(fmt::format("{} tiles with {}", contours.files, what));
  }
  warn_of_other_tiles(contours.other_files, options.output, progress);
  progress.say(fmt::format("{} vertices, {} triangles; {} {} of {} points, {:.2f} s",
                           report.mesh.vertices, report.mesh.simplices,
                           options.bands ? contours.polygons : contours.lines,
                           options.bands ? "polygons" : "lines", contours.points, facts.seconds));
}

int run(const ContourCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const ContourOptions how = contour_options(options);
  check_statistics_file(options, options.output, "the lines");
  ProgressLine progress = make_progress(options.report, options.output);
  const Context context = terrain_context(options, progress);
  const auto contours = create_contours(options.output, how, context);
  const TracedReport report = send_terrain(options, *contours, context);
  if (!is_first_rank()) return kExitDone;
  const RunFacts facts = facts_of_run(options, options.output, context, start);
  say(options, report, contours->report(), facts, progress);
  const Json lines = {{"lines", contours->report().lines},
                      {"short_lines", contours->report().short_lines},
                      {"polygons", contours->report().polygons},
                      {"points", contours->report().points},
                      {"outside_tiles", contours->report().outside_tiles},
                      {"files", contours->report().files},
                      {"spilled_bytes", contours->report().spilled_bytes}};
  write_statistics(options, report, facts, {{"contours", lines}});
  return tell_skipped(report.skipped_files, progress);
}

}  // namespace

Subcommand add_contour(CommandLine& root) {
  const auto options = std::make_shared<ContourCommandOptions>();
  CommandLine& app = root.add_subcommand("contour", "Draw lines of equal height");
  app.set_footer(kExamples);
  app.add_option("-o,--output", options->output,
                 "Vector file: " + vector_extensions(false) +
                     "; of --tiles a pattern, like lines_{x}_{y}.gpkg")
      .required()
      .value_name("FILE")
      // It also permits longitude and latitude to be something else.
      .each([options = options.get()](const std::string& path) {
        const VectorFormat* const format = vector_format_of_path(path);
        if (format != nullptr && format->is_lonlat)
          options->own_options.emplace_back("--force-crs");
      });
  take_positive_number(app.add_option("--interval", options->interval, "Height between two lines"))
      .value_name("H");
  take_number(app.add_option("--base", options->base, "A height that intervals are counted from"))
      .value_name("H")
      .show_default();
  add_number_list(app, "--levels", options->levels, "Heights of lines, instead of an interval")
      .value_name("H,...");
  take_whole_number(app.add_option("--index", options->index,
                                   "Every N-th line from the base is an index contour"),
                    1)
      .value_name("N")
      .show_default();
  add_tiles(app, options->tiles,
            "Cut lines into files, of squares of this side or of the polygons of a file")
      // The coordinate system of polygons is compared with that of a mesh, too.
      .each([options = options.get()](const std::string& text) {
        if (!parse_number(text)) options->own_options.emplace_back("--force-crs");
      });
  take_positive_number(
      app.add_option("--min-length", options->min_length, "Leave out lines that are shorter"))
      .value_name("L");
  take_positive_number(
      app.add_option("--smooth", options->smooth, "Smooth lines, moving them by at most this"))
      .value_name("T");
  take_positive_number(app.add_option("--simplify", options->simplify,
                                      "Leave out points, moving lines by at most this"))
      .value_name("T");
  app.add_flag("--bands", options->bands, "Polygons between levels, instead of lines");
  add_terrain_options(app, *options);
  options->uses_crs = true;
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }, true};
}

}  // namespace spillway::command

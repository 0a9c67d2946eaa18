#include <fmt/format.h>
#include <spillway/convert.h>
#include <spillway/generate.h>

#include <charconv>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include "formats/points/create_points.h"
#include "formats/points/point_formats.h"
#include "tools/commands/command.h"
#include "tools/commands/run_statistics.h"
#include "tools/options/command_options.h"
#include "tools/options/point_output.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway generate terrain -n 1e6 -o hills.las          airborne LiDAR as a scanner makes "
    "it\n"
    "  spillway generate scan -n 1e6 -o houses.las            houses as a scanner on a tripod sees "
    "them\n"
    "  spillway generate uniform -n 1e5 --dim 3 -o cube.npy\n"
    "  spillway generate circle -n 1000 | spillway triangulate - -o disc.obj\n"
    "  spillway generate terrain -n 1e8 --grid 20x20 -o 'survey/hills_#.las'  400 overlapping "
    "files\n"
    "LAS and LAZ take the families of integers: lattice, terrain, scan, duplicates, collinear, "
    "coplanar.\n"
    "The same family, number, dimension and seed give the same points on every machine.";

struct GenerateCommandOptions {
  const CommandLine* app = nullptr;
  std::string family;
  std::string count;
  int dimension = 2;
  std::uint64_t seed = 1;
  std::string grid;
  double overlap = 0.05;
  PointOutput output;
  ReportOptions report;
};

struct GridSize {
  int columns = 0;
  int rows = 0;
};

/// Reads COLUMNSxROWS. Throws UsageError for anything else.
GridSize parse_grid(std::string_view text) {
  GridSize size;
  const char* const end = text.data() + text.size();
  const auto columns = std::from_chars(text.data(), end, size.columns);
  if (columns.ec == std::errc{} && columns.ptr != end && *columns.ptr == 'x') {
    const auto rows = std::from_chars(columns.ptr + 1, end, size.rows);
    if (rows.ec == std::errc{} && rows.ptr == end && size.columns > 0 && size.rows > 0) return size;
  }
  throw UsageError(fmt::format("'{}' is no grid: write columns x rows, as in 20x20", text));
}

void check_options(const GenerateCommandOptions& options) {
  if (options.family == "terrain") {
    refuse_given(*options.app, {"--dim"}, "on terrain, which always has z");
  }
  if (options.grid.empty()) {
    refuse_given(*options.app, {"--overlap"}, "without --grid");
    if (options.family == "lattice") {
      refuse_given(*options.app, {"--seed"}, "on lattice, of which there is only one");
    }
  } else if (options.output.path == "-") {
    throw UsageError(
        "standard output cannot take a grid of files: name them with -o, with a # for column and "
        "row, as in -o 'hills_#.las'");
  }
}

GenerateOptions points_of(const GenerateCommandOptions& options) {
  return {.family = options.family,
          .count = parse_point_count(options.count),
          .dimension = options.dimension,
          .seed = options.seed};
}

/// What was written, in words and in figures.
struct Written {
  std::string text;
  std::uint64_t points = 0;
  std::uint64_t files = 1;
};

/// Writes one file.
Written write_file(const GenerateCommandOptions& options, const std::string& format,
                   const Context& context) {
  const auto points = generate_points(points_of(options));
  const auto file = create_points(
      options.output.path,
      {.format = format, .las_version = options.output.las_version, .exact = true}, context);
  const PointConversion done = convert(*points, *file, context);
  return {fmt::format("{} points of {} written to {}", done.written, options.family,
                      options.output.name()),
          done.written};
}

Written write_grid(const GenerateCommandOptions& options, const std::string& format,
                   const Context& context) {
  const GridSize size = parse_grid(options.grid);
  const GridReport done = generate_grid(points_of(options), options.output.path,
                                        {.columns = size.columns,
                                         .rows = size.rows,
                                         .overlap = options.overlap,
                                         .format = format,
                                         .las_version = options.output.las_version},
                                        context);
  std::string text =
      fmt::format("{} points of {} written to {} file{} {}", done.points, options.family,
                  done.files, done.files == 1 ? "" : "s", options.output.name());
  const auto tiles = static_cast<std::uint64_t>(size.columns) * size.rows;
  if (const std::uint64_t empty = tiles - done.files; empty > 0) {
    text += fmt::format(", none for {} tile{} without points", empty, empty == 1 ? "" : "s");
  }
  return {text, done.points, done.files};
}

int run(const GenerateCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check_options(options);
  check_figures_file(options.report, {}, options.output.path, "the points");
  const bool is_grid = !options.grid.empty();
  const std::string format = is_grid ? options.output.format : format_name_of(options.output);
  check_las_version(options.output,
                    point_format_to_write(options.output.path, format).has_versions);
  // How messages are written is settled before there is anything that an interruption would remove.
  ProgressLine progress = make_progress(options.report, options.output.path);
  const Context context(context_options({}, 0, progress));
  const Written done =
      is_grid ? write_grid(options, format, context) : write_file(options, format, context);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  write_figures(options.report,
                {{"family", options.family},
                 {"output", options.output.path},
                 {"output_files", done.files},
                 {"points", done.points}},
                start);
  progress.say(fmt::format("{}, {:.2f} s", done.text, seconds.count()));
  return kExitDone;
}

}  // namespace

Subcommand add_generate(CommandLine& root) {
  const auto options = std::make_shared<GenerateCommandOptions>();
  CommandLine& app = root.add_subcommand("generate", "Make points to try things with");
  options->app = &app;
  app.set_footer(
      fmt::format("FAMILY is one of {}.\n\n{}", fmt::join(point_families(), ", "), kExamples));
  add_choice(app, "FAMILY", options->family, point_families(), "What the points look like")
      .required();
  take_parsed(app.add_option("-n,--count", options->count, "How many points; 1e6 is a million"),
              parse_point_count)
      .required()
      .value_name("N");
  add_dimension(app, options->dimension, "Dimension; terrain and scan always have z", 6);
  take_whole_number(app.add_option("--seed", options->seed, "Another seed, other points"))
      .value_name("S")
      .show_default();
  take_parsed(app.add_option("--grid", options->grid,
                             "Write a survey: a file for each tile of an uneven grid; -o has # for "
                             "column and row"),
              parse_grid)
      .value_name("CxR");
  take_number_between(
      app.add_option("--overlap", options->overlap, "By how much tiles overlap, in their sides"), 0,
      0.4)
      .value_name("SHARE")
      .show_default();
  app.add_option("-o,--output", options->output.path, "Point file; - is standard output")
      .value_name("FILE")
      .show_default();
  add_choice(app, "--output-format", options->output.format, written_point_format_names(),
             "Format, where the name does not tell; spp on a pipe");
  add_las_version(app, options->output);
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }};
}

}  // namespace spillway::command

#include <fmt/format.h>
#include <spillway/convert.h>
#include <spillway/generate.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "formats/points/create_points.h"
#include "formats/points/point_formats.h"
#include "tools/commands/command.h"
#include "tools/options/command_options.h"
#include "tools/options/point_output.h"

namespace spillway::detail {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway generate terrain -n 1e6 -o hills.las          airborne LiDAR as a scanner makes "
    "it\n"
    "  spillway generate uniform -n 1e5 --dim 3 -o cube.npy\n"
    "  spillway generate circle -n 1000 | spillway triangulate - -o disc.obj\n"
    "LAS takes the families of integers: lattice, terrain, duplicates, collinear, coplanar.\n"
    "The same family, number, dimension and seed give the same points on every machine.";

struct GenerateCommandOptions {
  const CommandLine* app = nullptr;
  std::string family;
  std::string count;
  int dimension = 2;
  std::uint64_t seed = 1;
  PointOutput output;
  ReportOptions report;
};

int run(const GenerateCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  if (options.family == "terrain") {
    refuse_given(*options.app, {"--dim"}, "on terrain, which always has z");
  }
  if (options.family == "lattice") {
    refuse_given(*options.app, {"--seed"}, "on lattice, of which there is only one");
  }
  const auto points = generate_points({.family = options.family,
                                       .count = parse_point_count(options.count),
                                       .dimension = options.dimension,
                                       .seed = options.seed});
  const std::string format = format_name_of(options.output);
  check_las_version(options.output,
                    point_format_to_write(options.output.path, format).has_versions);
  // How messages are written is settled before there is anything that an interruption would remove.
  Progress progress = make_progress(options.report);
  const Context context(context_options({}, 0, progress));
  const auto file = create_points(
      options.output.path,
      {.format = format, .las_version = options.output.las_version, .exact = true}, context);
  const PointConversion done = convert(*points, *file, context);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  progress.say(fmt::format("{} points of {} written to {}, {:.2f} s", done.written, options.family,
                           options.output.name(), seconds.count()));
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
  add_dimension(app, options->dimension, "Dimension; terrain always has z");
  take_whole_number(app.add_option("--seed", options->seed, "Another seed, other points"))
      .value_name("S")
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

}  // namespace spillway::detail

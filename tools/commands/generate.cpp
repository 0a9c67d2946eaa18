#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "formats/points/common/point_writer.h"
#include "formats/points/create_points.h"
#include "src/generators/generators.h"
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

constexpr std::size_t kBlockSize = 65536;  // points made and written at a time

struct GenerateOptions {
  const CommandLine* app = nullptr;
  std::string family;
  std::string count;
  int dimension = 2;
  std::uint64_t seed = 1;
  PointOutput output;
  ReportOptions report;
};

int run(const GenerateOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  GeneratorOptions what;
  what.family = family_by_name(options.family);
  what.count = parse_point_count(options.count);
  what.dimension = options.dimension;
  what.seed = options.seed;
  if (what.family == Family::kTerrain) {
    refuse_given(*options.app, {"--dim"}, "on terrain, which always has z");
  }
  if (what.family == Family::kLattice) {
    refuse_given(*options.app, {"--seed"}, "on lattice, of which there is only one");
  }
  const auto generator = make_generator(what);

  PointWriterOptions how;
  how.format = format_name_of(options.output);
  how.version = options.output.las_version;
  const PointFormat& format = point_format_to_write(options.output.path, how.format);
  check_las_version(options.output, format.has_versions);
  how.coordinates =
      what.dimension == 3 || what.family == Family::kTerrain || format.needs_heights ? 3 : 2;
  how.count = what.count;
  if (generator->lattice() != nullptr) how.lattice = *generator->lattice();
  // How messages are written is settled before there is anything that an interruption would remove.
  Progress progress = make_progress(options.report);
  const auto writer = open_point_writer(disk(), options.output.path, how);

  progress.begin("generate", "points");
  std::vector<Point<3>> block(std::min<std::uint64_t>(kBlockSize, what.count));
  std::uint64_t written = 0;
  while (written < what.count) {
    const std::size_t made = generator->next(block);
    writer->write(std::span(block).first(made), {});
    written += made;
    progress.update(written, static_cast<double>(written) / static_cast<double>(what.count));
    if (made < block.size()) break;
  }
  writer->finish();
  progress.end(written);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  progress.say(fmt::format("{} points of {} written to {}, {:.2f} s", written, options.family,
                           options.output.name(), seconds.count()));
  return kExitDone;
}

}  // namespace

Subcommand add_generate(CommandLine& root) {
  const auto options = std::make_shared<GenerateOptions>();
  CommandLine& app = root.add_subcommand("generate", "Make points to try things with");
  options->app = &app;
  app.set_footer(
      fmt::format("FAMILY is one of {}.\n\n{}", fmt::join(family_names(), ", "), kExamples));
  add_choice(app, "FAMILY", options->family, family_names(), "What the points look like")
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

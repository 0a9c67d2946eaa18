#include <fmt/format.h>
#include <spillway/density.h>
#include <spillway/triangulate.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/distributed/ranks.h"
#include "src/geometry/simplex_name.h"
#include "tools/commands/command.h"
#include "tools/commands/run_statistics.h"
#include "tools/commands/skipped_inputs.h"
#include "tools/options/command_options.h"
#include "tools/options/input_options.h"
#include "tools/options/periodic_option.h"
#include "tools/options/triangulation_options.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway density halos.npy --dim 3 --periodic 0,0,0,100,100,100 -o halos.vtu\n"
    "  spillway density halos.npy --dim 3 --periodic 0,0,0,100,100,100 --grid 256,256,256 -o "
    "rho.npy\n"
    "  spillway density trees.las --grid 500,400 --grid-box 0,0,5000,4000 -o trees.tif\n"
    "  spillway density gas.csv --dim 3 --weight mass -o density.npy\n"
    "docs/density.md tells what a density is at a vertex, and in between.";

struct DensityCommandOptions : TriangulationOptions {
  std::string output;
  int dimension = 2;
  std::string periodic;
  std::string weight;
  std::string cells;
  std::string grid_box;
};

/// Throws UsageError for what is no list of two or three numbers of cells.
std::vector<std::uint32_t> parse_cells(std::string_view text) {
  std::vector<std::uint32_t> cells;
  for (const std::string_view part : split(text, ',')) {
    const double number = parse_number(part).value_or(0);
    if (!(number >= 1 && number <= 1e6 && number == static_cast<std::uint32_t>(number))) {
      throw UsageError(fmt::format(
          "\"{}\" is not a grid; give its cells along each axis, from 1 to 1000000, as 256,256",
          text));
    }
    cells.push_back(static_cast<std::uint32_t>(number));
  }
  if (cells.size() != 2 && cells.size() != 3) {
    throw UsageError(fmt::format("\"{}\" is not a grid of 2 or 3 axes", text));
  }
  return cells;
}

void add_options(CommandLine& app, DensityCommandOptions& options) {
  app.add_option("IN", options.inputs, "Point files, folders, 'patterns', @lists; - is a pipe")
      .required();
  app.add_option("-o,--output", options.output,
                 "Densities at vertices: npy, or a mesh as vtu, spm or ply; of a grid: npy, tif")
      .required()
      .value_name("FILE");
  add_dimension(app, options.dimension, "2: points by area, of x and y; 3: by volume", 3);
  add_periodic(app, options.periodic);
  app.add_option("--weight", options.weight, "The attribute of points that is their mass [1 each]")
      .value_name("NAME");
  take_parsed(app.add_option("--grid", options.cells,
                             "Interpolate at the centers of a grid of so many cells along each "
                             "axis, as 256,256"),
              [](const std::string& text) { parse_cells(text); })
      .value_name("CELLS");
  take_parsed(app.add_option("--grid-box", options.grid_box,
                             "Where the grid lies [the periodic box, or that of the points]"),
              parse_bounds)
      .value_name("BOX");
  add_triangulation_options(app, options);
  add_report_options(app, options.report);
}

DensityOptions density_options(const DensityCommandOptions& options) {
  DensityOptions density;
  density.weight = options.weight;
  if (!options.cells.empty()) {
    const std::vector<std::uint32_t> cells = parse_cells(options.cells);
    if (cells.size() != static_cast<std::size_t>(options.dimension)) {
      throw UsageError(
          fmt::format("--grid has {} axes, and the densities {}", cells.size(), options.dimension));
    }
    std::copy(cells.begin(), cells.end(), density.cells.begin());
  }
  if (!options.grid_box.empty()) {
    if (options.cells.empty()) throw UsageError("--grid-box has no effect without --grid");
    density.grid_box = parse_bounds(options.grid_box);
  }
  return density;
}

int run(const DensityCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  refuse_given(*options.app, {"--max-edge", "--heights", "--resume"},
               "on densities, which all simplices around a point make");
  if (distributed::launch().as_ranks) {
    throw UsageError("densities are made by one process: start it without mpirun");
  }
  check_statistics_file(options, options.output, "the densities");
  const DensityOptions density = density_options(options);
  TriangulateOptions how = triangulate_options(options, options.dimension);
  how.periodic = periodic_box(options.periodic, options.dimension);
  ProgressLine progress = make_progress(options.report, options.output);
  const Context context(context_options(options.memory, thread_count(options), progress));
  reuse_freed_memory();
  const auto sink = create_density(options.output, density, context);
  const auto points =
      open_points(options.inputs, point_options(options.input, options.dimension), context);
  const TracedReport report = triangulate_and_trace(options, *points, *sink, how, context, nullptr);
  write_statistics(options, report, facts_of_run(options, options.output, context, start));
  if (!report.points.all_kept() || report.points.wrapped > 0) {
    progress.say(describe(report.points));
  }
  const DensityTotals totals = sink->totals();
  progress.say(fmt::format(
      "{} points, {} equal ones left out, mass {:.12g}, {} {:.12g}, density "
      "{:.6g} to {:.6g}",
      report.mesh.points, report.mesh.duplicates, totals.mass,
      options.dimension == 2 ? "area" : "volume", totals.volume, totals.least, totals.most));
  return tell_skipped(report.skipped_files, progress);
}

}  // namespace

Subcommand add_density(CommandLine& root) {
  const auto options = std::make_shared<DensityCommandOptions>();
  CommandLine& app = root.add_subcommand("density", "Make densities of points");
  app.set_footer(kExamples);
  add_options(app, *options);
  return {&app, [options] { return run(*options); }, true};
}

}  // namespace spillway::command

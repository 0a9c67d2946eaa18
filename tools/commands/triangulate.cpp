#include <fmt/format.h>
#include <spillway/triangulate.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/meshes/mesh_formats.h"
#include "formats/points/npy/npy_format.h"
#include "formats/points/point_formats.h"
#include "formats/rasters/raster_formats.h"
#include "formats/vectors/vector_formats.h"
#include "src/distributed/ranks.h"
#include "src/geometry/canonical_hash.h"
#include "src/geometry/simplex_name.h"
#include "src/runtime/memory_budget.h"
#include "tools/commands/command.h"
#include "tools/commands/run_statistics.h"
#include "tools/commands/skipped_inputs.h"
#include "tools/commands/tile_files.h"
#include "tools/options/command_options.h"
#include "tools/options/input_options.h"
#include "tools/options/periodic_option.h"
#include "tools/options/triangulation_options.h"
#include "tools/process/rank_job.h"
#include "tools/report/speed_up_estimate.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"
#include "tools/simulate/core_simulation.h"
#include "tools/simulate/run_recorder.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway triangulate survey.las -o tin.ply\n"
    "  spillway triangulate north.las south.las -o tin.vtu --heights lowest\n"
    "  zcat points.txt.gz | spillway triangulate - -o - --output-format obj > tin.obj\n"
    "  spillway triangulate survey.laz -o 'tin_{x}_{y}.ply' --tiles 1000\n"
    "  spillway triangulate scan.npy --dim 3 -o tetrahedra.vtu --stats run.json\n"
    "  spillway triangulate survey.las -o tin.ply --simulate-cores 1,2,4,...,1024\n"
    "  spillway triangulate survey.las -o tin.spm --memory 512M --scratch-folder /scratch\n"
    "  spillway triangulate 'tiles/*.la[sz]' -o ground.ply --keep-class 2 --thin 0.5:lowest\n"
    "  spillway generate terrain -n 1e8 | spillway triangulate - -o - | spillway info -\n"
    "  mpirun -n 8 spillway triangulate survey.las -o tin.spm --scratch-folder /local\n"
    "The output gets its name when it is complete, so it may replace an input.";

struct TriangulateCommandOptions : TriangulationOptions {
  std::string output;
  std::string output_format;
  int dimension = 2;
  bool input_index = false;
  std::string attributes;  ///< as --attributes takes them
  std::string core_list;
  std::string disk_speed;
  std::string simulated_points;
  bool parts = false;
  std::string tiles;
  std::string periodic;

  [[nodiscard]] bool simulates() const { return !core_list.empty(); }
};

void add_options(CommandLine& app, TriangulateCommandOptions& options) {
  app.add_option("IN", options.inputs,
                 "Point files, folders, 'patterns', @lists: one triangulation; - is a pipe")
      .required();
  app.add_option("-o,--output", options.output,
                 "Mesh file; - is standard output, as spm; of --tiles a pattern, like "
                 "tin_{x}_{y}.ply")
      .required()
      .value_name("FILE");
  add_dimension(
      app, options.dimension,
      "2: triangles over x, y, with z carried along; 3: tetrahedra; 4 to 6: simplices, of "
      "npy arrays with so many columns, and of points with attributes x4, x5, x6",
      6);
  add_periodic(app, options.periodic);
  app.add_flag("--id", options.input_index, "Write each vertex's index in the input");
  add_attributes(app, options.attributes,
                 "Attributes of points that vertices keep [none; of ply the colour]");
  app.add_flag(
      "--parts", options.parts,
      "Under mpirun: a file for each rank, NAME.0.EXT, NAME.1.EXT, ... (vtu: and NAME.pvtu)");
  add_tiles(app, options.tiles,
            "A file for each square of this side, or each polygon of a file, of whole simplices");
  app.add_flag("--clip-simplices", options.input.clips_product,
               "Let --clip leave out simplices by their centroids, and use all points");
  add_choice(app, "--output-format", options.output_format, mesh_format_names(),
             "Format of the mesh, where the name does not tell");
  add_triangulation_options(app, options);
  take_parsed(app.add_option(
                  "--simulate-cores", options.core_list,
                  "Run on one thread and print what so many cores would take, as 1,2,4,...,1024"),
              parse_core_list)
      .value_name("LIST")
      .group(kTuningGroup);
  take_parsed(app.add_option("--simulate-disk", options.disk_speed,
                             "Bytes a second of the simulated disk, as 500M or 2G; none: as many "
                             "as are needed"),
              parse_memory_size)
      .value_name("SPEED")
      .group(kTuningGroup);
  take_parsed(app.add_option("--simulate-points", options.simulated_points,
                             "Points of the simulated run, made of copies of the one measured"),
              parse_point_count)
      .value_name("N")
      .group(kTuningGroup);
  add_report_options(app, options.report);
}

/// Says what the third column of npy is taken for, which has numbers without names.
void say_what_heights_are(const TriangulateCommandOptions& options, const PointsHeader& points,
                          ProgressLine& progress) {
  if (options.app->is_given("--dim") || points.coordinates == 2 || !is_first_rank()) return;
  const auto is_npy = [](const std::string& input) {
    return point_format_of_path(input) == &kNpyPoints;
  };
  if (options.input.format != kNpyPoints.name && std::ranges::none_of(options.inputs, is_npy)) {
    return;
  }
  progress.say(
      "npy does not tell what its columns are: x and y are triangulated, and z is carried along; "
      "--dim 3 makes tetrahedra");
}

void say(const TriangulateCommandOptions& options, const Report& report, const RunFacts& facts,
         ProgressLine& progress) {
  if (!report.points.all_kept() || report.points.wrapped > 0) {
    progress.say(describe(report.points));
  }
  if (report.left_out > 0) {
    progress.say(
        fmt::format("{} simplices with an edge longer than {} left out: this is no longer the "
                    "Delaunay triangulation of all points",
                    report.left_out, *max_edge(options)));
  }
  if (!options.tiles.empty()) {
    say_mesh_tiles(report, options.output, progress);
  }
  if (options.input.clips_product) {
    say_clipped(report, progress);
  }
  if (report.spilled_points > 0) {
    progress.detail(
        fmt::format("{} tiles, {} of points spilled to the disk, {} of border resident "
                    "at most",
                    report.tiles, memory_size_text(report.spilled_bytes),
                    memory_size_text(report.border_bytes)));
  }
  progress.say(fmt::format("{} points, {} duplicates, {} vertices, {} {}, hash {}, {:.2f} s",
                           report.mesh.points, report.mesh.duplicates, report.mesh.vertices,
                           report.mesh.simplices, simplices_of(report.dimension),
                           hash_to_hex(report.mesh.canonical_hash), facts.seconds));
  if (!report.lost.empty()) progress.say(fmt::format("not kept: {}", fmt::join(report.lost, ", ")));
  const MeshFormat& format = mesh_format(options.output, report.output_format);
  const std::string note = rounding_note(format, options.output);
  if (!note.empty()) progress.say(note);
  if (facts.simulated.empty()) return;
  // The table is what was asked for; it gives way only to a mesh on standard output.
  const std::string table =
      fmt::format(
          "what the whole command would take for {} points, steps measured on one thread:\n",
          facts.simulated_points) +
      simulation_table(facts.simulated);
  if (options.output == "-") {
    progress.say(table);
  } else {
    write_text("-", table + "\n");
  }
}

/// For reuse_freed_memory(): the leaves of space are large, and so are their buffers.
std::size_t kept_memory(int dimension, std::uint64_t limit) {
  constexpr std::uint64_t kLeast = 16 << 20;
  constexpr std::uint64_t kMost = 128 << 20;
  return dimension == 2 ? kLeast : std::clamp(limit / 8, kLeast, kMost);
}

/// Throws for a file that another subcommand makes.
void refuse_other_output(const std::string& path) {
  if (mesh_format_of_extension(path) != nullptr) return;
  const char* subcommand = nullptr;
  if (kGeoTiff.is_named(path)) subcommand = "dem";
  if (kPng.is_named(path)) subcommand = "render";
  if (vector_format_of_path(path) != nullptr) subcommand = "contour";
  if (point_format_of_path(path) != nullptr) subcommand = "convert";
  if (subcommand == nullptr) return;
  throw UsageError(
      fmt::format("-o {}: this is not a mesh; it is what spillway {} makes", path, subcommand));
}

/// The run on as many cores as asked for.
void simulate(const TriangulateCommandOptions& options, RunModel run, RunFacts& facts) {
  if (!options.simulated_points.empty()) {
    run = enlarge(run, parse_point_count(options.simulated_points));
  }
  const std::uint64_t speed =
      options.disk_speed.empty() ? 0 : parse_memory_size(options.disk_speed);
  facts.simulated_points = run.points;
  facts.simulated =
      simulate_cores(run, parse_core_list(options.core_list), static_cast<double>(speed));
}

void check_options(const TriangulateCommandOptions& options) {
  const auto check_unused = [&](bool given, const char* option) {
    if (options.simulates() || !given) return;
    throw UsageError(fmt::format("{} has no effect without --simulate-cores", option));
  };
  check_unused(!options.disk_speed.empty(), "--simulate-disk");
  check_unused(!options.simulated_points.empty(), "--simulate-points");
  if (options.simulates()) {
    parse_core_list(options.core_list);
    if (options.threads > 1) {
      throw UsageError("--simulate-cores measures tasks on one thread: leave --threads out");
    }
    if (distributed::launch().as_ranks) {
      throw UsageError("--simulate-cores is for one process: start it without mpirun");
    }
  }
  check_duplicates(options, options.dimension);
  periodic_box(options.periodic, options.dimension);
  if (options.tiles.empty()) {
    refuse_pattern(options.output);
  } else if (options.parts || distributed::launch().as_ranks) {
    throw UsageError(
        "--tiles is for one process: write one mesh over ranks, and cut it with spillway convert");
  }
  if (options.output_format.empty()) refuse_other_output(options.output);
  // mpirun gives its processes a terminal as standard output, whatever its own is.
  const bool on_terminal = ::isatty(STDOUT_FILENO) != 0 && !distributed::launch().as_ranks;
  if (options.output == "-" && on_terminal && options.output_format.empty()) {
    throw UsageError("a mesh stream cannot go to a terminal: name a file, or pipe it on");
  }
  check_statistics_file(options, options.output, "the mesh");
}

int run(const TriangulateCommandOptions& options) {
  check_options(options);
  const auto start = std::chrono::steady_clock::now();
  std::optional<RunRecorder> recorder(std::in_place);
  ProgressLine progress = make_progress(options.report, options.output);
  ContextOptions limits =
      context_options(options.memory, options.simulates() ? 1 : thread_count(options), progress);
  limits.executor = rank_executor();
  const Context context(limits);
  reuse_freed_memory(kept_memory(options.dimension, context.memory()));
  const TileChoice tiles = parse_tiles(options.tiles);
  const auto mesh = create_mesh(options.output,
                                {.format = options.output_format,
                                 .parts = options.parts,
                                 .attributes = attribute_names(options.attributes),
                                 .tile_side = tiles.side,
                                 .tile_polygons = tiles.polygons,
                                 .clip = product_clip(options.input),
                                 .foreign_crs = options.input.force_crs},
                                context);
  const auto points =
      open_points(options.inputs, point_options(options.input, options.dimension), context);
  check_heights(options, points->header());
  say_what_heights_are(options, points->header(), progress);
  TriangulateOptions how = triangulate_options(options, options.dimension);
  how.input_index = options.input_index;
  how.periodic = periodic_box(options.periodic, options.dimension);
  const TracedReport report = triangulate_and_trace(options, *points, *mesh, how, context,
                                                    options.simulates() ? &recorder : nullptr);
  if (!is_first_rank()) return kExitDone;
  RunFacts facts = facts_of_run(options, options.output, context, start);
  if (options.simulates()) {
    simulate(options, recorder->take(report, report.output_bytes), facts);
  }
  write_statistics(options, report, facts);
  say(options, report, facts, progress);
  return tell_skipped(report.skipped_files, progress);
}

}  // namespace

Subcommand add_triangulate(CommandLine& root) {
  const auto options = std::make_shared<TriangulateCommandOptions>();
  CommandLine& app = root.add_subcommand("triangulate", "Make a Delaunay mesh of points");
  app.set_footer(kExamples);
  add_options(app, *options);
  return {&app, [options] { return run(*options); }, true};
}

}  // namespace spillway::command

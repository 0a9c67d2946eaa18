#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/mesh_stream_writer.h"
#include "formats/points/point_formats.h"
#include "formats/rasters/raster_formats.h"
#include "formats/vectors/vector_formats.h"
#include "src/distributed/ranks.h"
#include "src/geometry/canonical_hash.h"
#include "src/runtime/memory_budget.h"
#include "stream/pipeline.h"
#include "stream/ranks/mesh_output.h"
#include "stream/ranks/rank_pipeline.h"
#include "stream/ranks/together.h"
#include "tools/commands/command.h"
#include "tools/commands/output_check.h"
#include "tools/options/command_options.h"
#include "tools/options/input_options.h"
#include "tools/options/triangulation_options.h"
#include "tools/process/rank_job.h"
#include "tools/report/core_simulation.h"
#include "tools/report/json_text.h"
#include "tools/report/rank_statistics.h"
#include "tools/report/statistics.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"

namespace spillway::detail {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway triangulate survey.las -o tin.ply\n"
    "  spillway triangulate north.las south.las -o tin.vtu --duplicates lowest\n"
    "  zcat points.txt.gz | spillway triangulate - -o - --output-format obj > tin.obj\n"
    "  spillway triangulate scan.npy --dim 3 -o tetrahedra.vtu --stats run.json\n"
    "  spillway triangulate survey.las -o tin.ply --simulate-cores 1,2,4,...,1024\n"
    "  spillway triangulate survey.las -o tin.spm --memory 512M --tmpdir /scratch\n"
    "  spillway triangulate 'tiles/*.la[sz]' -o ground.ply --keep-class 2 --thin 0.5:lowest\n"
    "  spillway generate terrain -n 1e8 | spillway triangulate - -o - | spillway info -\n"
    "  mpirun -n 8 spillway triangulate survey.las -o tin.spm --tmpdir /local\n"
    "The output gets its name when it is complete, so it may replace an input.";

struct TriangulateOptions : TriangulationOptions {
  std::string output;
  std::string output_format;
  int dimension = 2;
  bool input_index = false;
  std::string core_list;
  bool parts = false;

  [[nodiscard]] bool simulates() const { return !core_list.empty(); }
};

void add_options(CommandLine& app, TriangulateOptions& options) {
  app.add_option("IN", options.inputs,
                 "Point files, folders, 'patterns', @lists: one triangulation; - is a pipe")
      .required();
  app.add_option("-o,--output", options.output, "Mesh file; - is standard output, as spm")
      .required()
      .value_name("FILE");
  add_dimension(app, options.dimension,
                "2: triangles over x, y, with z carried along; 3: tetrahedra");
  app.add_flag("--id", options.input_index, "Write each vertex's index in the input");
  app.add_flag(
      "--parts", options.parts,
      "Under mpirun: a file for each rank, NAME.0.EXT, NAME.1.EXT, ... (vtu: and NAME.pvtu)");
  add_choice(app, "--output-format", options.output_format, mesh_format_names(),
             "Format of the mesh, where the name does not tell");
  add_triangulation_options(app, options);
  take_parsed(app.add_option(
                  "--simulate-cores", options.core_list,
                  "Run on one thread and print what so many cores would take, as 1,2,4,...,1024"),
              parse_core_list)
      .value_name("LIST");
  add_report_options(app, options.report);
}

void report(const TriangulateOptions& options, const RunStatistics& statistics,
            Progress& progress) {
  const StreamFigures& stream = statistics.stream;
  if (statistics.input.dropped() > 0) progress.say(describe(statistics.input));
  if (stream.left_out > 0) {
    progress.say(
        fmt::format("{} simplices with an edge longer than {} left out: this is no longer the "
                    "Delaunay triangulation of all points",
                    stream.left_out, *statistics.max_edge));
  }
  if (stream.spilled_points > 0) {
    progress.detail(
        fmt::format("{} tiles, {} of points spilled to the disk, {} of border resident "
                    "at most",
                    stream.tiles, memory_size_text(stream.spilled_bytes),
                    memory_size_text(stream.border_bytes)));
  }
  progress.say(fmt::format("{} points, {} duplicates, {} vertices, {} {}, hash {}, {:.2f} s",
                           stream.totals.points, stream.totals.duplicates, stream.totals.vertices,
                           stream.totals.simplices,
                           statistics.dimension == 2 ? "triangles" : "tetrahedra",
                           hash_to_hex(stream.totals.canonical_hash), statistics.seconds));
  const MeshFormat& format = mesh_format(options.output, statistics.output_format);
  if (const std::string note = rounding_note(format); !note.empty()) progress.say(note);
  if (options.simulates()) {
    // The table is what was asked for; it gives way only to a mesh on standard output.
    const std::string table =
        "what the triangulation alone would take, tasks measured on one thread:\n" +
        simulation_table(statistics.simulated);
    if (options.output == "-") {
      progress.say(table);
    } else {
      write_text("-", table + "\n");
    }
  }
}

/// For reuse_freed_memory(): the leaves of space are large, and so are their buffers.
std::size_t kept_memory(int dimension, std::uint64_t limit) {
  constexpr std::uint64_t kLeast = 16 << 20;
  constexpr std::uint64_t kMost = 128 << 20;
  return dimension == 2 ? kLeast : std::clamp(limit / 8, kLeast, kMost);
}

template <int D>
int run(const TriangulateOptions& options, const MeshTarget& target, RunStatistics& statistics) {
  const auto start = std::chrono::steady_clock::now();
  const auto& inputs = options.inputs;
  Progress progress =
      make_progress(options.report, std::count(inputs.begin(), inputs.end(), "-") > 0);
  StreamOptions stream = stream_options(options, progress);
  if (options.simulates()) stream.threads = 1;
  stream.input_index = options.input_index;
  statistics.max_edge = stream.max_edge;
  const distributed::Ranks* const ranks = join_ranks();
  MemoryBudget budget(memory_limit(options.memory));
  reuse_freed_memory(kept_memory(D, budget.limit()));
  const auto scratch = make_scratch_folder(options.memory);
  const auto points = make_point_source(
      disk(), options.inputs, options.input,
      {.dimension = D, .index = options.input_index, .memory = budget.limit(), .ranks = ranks},
      *scratch, progress);
  PointSource& source = *points;
  check_heights(options, source);
  MeshStreamHeader header;
  header.dimension = D;
  header.has_input_index = options.input_index;
  header.lattice = source.lattice();
  header.points = source.count();
  header.crs = source.crs();
  header.extent = source.world_extent();
  statistics.memory_limit = budget.limit();
  statistics.on_lattice = source.lattice().has_value();
  const auto finish = [&](const auto& finish_output) {
    progress.begin("write", D == 2 ? "triangles" : "tetrahedra");
    statistics.output_bytes = finish_output();
    statistics.write_seconds = progress.end(statistics.stream.totals.simplices);
  };
  if (ranks != nullptr) {
    const auto output = open_mesh_output(disk(), target, header, *scratch, *ranks);
    RankMesh mesh =
        triangulate_over_ranks<D>(source, output->writer(), *scratch, budget, stream, *ranks);
    statistics.input = source.counts();
    share_statistics(statistics, mesh, *ranks);
    do_together(*ranks, [&] { refuse_empty_mesh(statistics.stream, statistics.max_edge); });
    finish([&] { return output->finish(mesh); });
    if (ranks->rank() != 0) return kExitDone;
  } else {
    const auto writer =
        open_mesh_stream_writer(disk(), target.path, *target.format, header, *scratch);
    statistics.stream = triangulate_stream<D>(source, *writer, *scratch, budget, stream);
    if (statistics.stream.threads < stream.threads) {
      progress.detail(fmt::format("{} of {} threads used: more of them need more --memory",
                                  statistics.stream.threads, stream.threads));
    }
    statistics.input = source.counts();
    refuse_empty_mesh(statistics.stream, statistics.max_edge);
    finish([&] {
      writer->finish(statistics.stream.totals);
      return writer->bytes_written();
    });
  }

  if (options.simulates()) {
    statistics.simulated =
        simulate_cores(statistics.stream.tasks, parse_core_list(options.core_list));
  }
  statistics.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.stats_path.empty()) {
    write_text(options.stats_path, json_text(to_json(statistics), 2) + "\n");
  }
  report(options, statistics, progress);
  return kExitDone;
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
      fmt::format("-o {}: this is no mesh; it is what spillway {} makes", path, subcommand));
}

int run(const TriangulateOptions& options) {
  if (options.simulates()) {
    parse_core_list(options.core_list);
    if (options.threads > 1) {
      throw UsageError("--simulate-cores measures tasks on one thread: leave --threads away");
    }
    if (distributed::launch().as_ranks) {
      throw UsageError("--simulate-cores is for one process: start it without mpirun");
    }
  }
  check_duplicates(options, options.dimension);
  if (options.output == options.stats_path) {
    throw UsageError("the mesh and --stats cannot go to the same place: " + options.output);
  }
  if (options.output_format.empty()) refuse_other_output(options.output);
  const MeshTarget target = mesh_target(options.output, options.output_format, options.parts);
  if (target.parts && !distributed::launch().as_ranks) {
    throw UsageError("parts are a file for each rank: start it with mpirun");
  }
  // mpirun gives its processes a terminal as standard output, whatever its own is.
  const bool on_terminal = ::isatty(STDOUT_FILENO) != 0 && !distributed::launch().as_ranks;
  if (options.output == "-" && on_terminal && options.output_format.empty()) {
    throw UsageError("a mesh stream is nothing for a terminal: name a file, or pipe it on");
  }
  RunStatistics statistics;
  statistics.dimension = options.dimension;
  statistics.inputs = options.inputs;
  statistics.output = options.output;
  statistics.output_format = target.format->name;
  if (!options.stats_path.empty() && is_first_rank()) {
    check_can_create(disk(), options.stats_path);
  }
  return statistics.dimension == 3 ? run<3>(options, target, statistics)
                                   : run<2>(options, target, statistics);
}

}  // namespace

Subcommand add_triangulate(CommandLine& root) {
  const auto options = std::make_shared<TriangulateOptions>();
  CommandLine& app = root.add_subcommand("triangulate", "Make a Delaunay mesh of points");
  app.set_footer(kExamples);
  add_options(app, *options);
  return {&app, [options] { return run(*options); }, true};
}

}  // namespace spillway::detail

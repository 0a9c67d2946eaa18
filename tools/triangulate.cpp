#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/mesh_stream_writer.h"
#include "formats/scratch_folder.h"
#include "src/error.h"
#include "src/geometry/canonical_hash.h"
#include "src/parallel/parallel.h"
#include "stream/memory_budget.h"
#include "stream/pipeline.h"
#include "stream/point_source.h"
#include "tools/command.h"
#include "tools/command_options.h"
#include "tools/core_simulation.h"
#include "tools/json_text.h"
#include "tools/output_check.h"
#include "tools/statistics.h"
#include "tools/text_output.h"

namespace spillway {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway triangulate survey.las -o tin.ply\n"
    "  spillway triangulate north.las south.las -o tin.vtu --duplicates lowest\n"
    "  zcat points.txt.gz | spillway triangulate - -o - --output-format obj > tin.obj\n"
    "  spillway triangulate scan.npy --dim 3 -o tetrahedra.vtu --stats run.json\n"
    "  spillway triangulate survey.las -o tin.ply --simulate-cores 1,2,4,...,1024\n"
    "  spillway triangulate survey.las -o tin.spm --memory 512M --tmpdir /scratch\n"
    "  spillway generate terrain -n 1e8 | spillway triangulate - -o - | spillway info -\n"
    "The output gets its name when it is complete, so it may replace an input.";

struct TriangulateOptions {
  std::vector<std::string> inputs;
  std::string output;
  std::string output_format;
  std::string dimension = "2";
  std::string duplicates = "first";
  std::string division = "longest";
  std::string max_edge;
  unsigned threads = 0;
  std::size_t base_case_size = 0;
  unsigned children = 2;
  MemoryOptions memory;
  std::size_t tile_capacity = 0;
  bool input_index = false;
  std::string stats_path;
  std::string core_list;
  PointReaderOptions reader;
  ReportOptions report;

  [[nodiscard]] bool simulates() const { return !core_list.empty(); }
};

void add_options(CLI::App& app, TriangulateOptions& options) {
  app.add_option("IN", options.inputs, "Point files; several make one triangulation; - is a pipe")
      ->required();
  app.add_option("-o,--output", options.output, "Mesh file; - is standard output, as spm")
      ->required()
      ->type_name("FILE");
  add_choice(app, "--dim", options.dimension, {"2", "3"},
             "2: triangles over x, y, with z carried along; 3: tetrahedra");
  add_choice(app, "--duplicates", options.duplicates, height_choice_names(),
             "Which z a vertex of several points of equal x, y gets");
  app.add_option("--max-edge", options.max_edge, "Leave out simplices with an edge longer than L")
      ->type_name("L");
  app.add_flag("--id", options.input_index, "Write each vertex's index in the input");
  add_choice(app, "--output-format", options.output_format, mesh_format_names(),
             "Format of the mesh, where the name does not tell");
  add_reader_options(app, options.reader);
  app.add_option("--threads", options.threads, "Threads to use; 0: all there are")
      ->type_name("N")
      ->check(CLI::Range(0, 4096).description(""))
      ->capture_default_str();
  add_memory_options(app, options.memory);
  app.add_option("--stats", options.stats_path, "Write figures and the task tree of the run")
      ->type_name("FILE");
  app.add_option("--base-case", options.base_case_size,
                 "Most points of one sequential base case (a leaf); 0: chosen by number and memory")
      ->type_name("N")
      ->check(CLI::Validator(CLI::NonNegativeNumber).description(""))
      ->capture_default_str();
  app.add_option("--tile", options.tile_capacity,
                 "Most points of a tile that is loaded at a time; 0: chosen by the memory")
      ->type_name("N")
      ->check(CLI::Validator(CLI::NonNegativeNumber).description(""))
      ->capture_default_str();
  add_choice(app, "--division", options.division, {"longest", "cycling", "constant"},
             "Which axis the division of points cuts");
  app.add_option("--children", options.children, "Parts that are merged at a time")
      ->type_name("K")
      ->check(CLI::Range(2, 1024).description(""))
      ->capture_default_str();
  app.add_option("--simulate-cores", options.core_list,
                 "Run on one thread and print what so many cores would take, as 1,2,4,...,1024")
      ->type_name("LIST");
  add_report_options(app, options.report);
}

DivisionScheme division_by_name(const std::string& name) {
  if (name == "cycling") return DivisionScheme::kCyclingAxis;
  if (name == "constant") return DivisionScheme::kConstantAxis;
  return DivisionScheme::kLongestExtent;
}

/// The length that --max-edge gives; nothing if it is not given.
std::optional<double> parse_max_edge(const std::string& text) {
  if (text.empty()) return std::nullopt;
  double length = 0;
  const bool number = CLI::detail::lexical_cast(text, length);
  if (!number || !(length > 0) || !std::isfinite(length)) {
    throw UsageError(fmt::format("--max-edge: \"{}\" is no length; give a number above 0", text));
  }
  return length;
}

StreamOptions stream_options(const TriangulateOptions& options, Progress& progress,
                             RunStatistics& statistics) {
  StreamOptions stream;
  stream.threads = options.simulates()    ? 1
                   : options.threads == 0 ? available_threads()
                                          : options.threads;
  stream.tile_capacity = options.tile_capacity;
  stream.leaf_size = options.base_case_size;
  stream.division = division_by_name(options.division);
  stream.children = options.children;
  stream.heights = height_choice_by_name(options.duplicates);
  stream.max_edge = parse_max_edge(options.max_edge);
  stream.input_index = options.input_index;
  stream.begin_phase = [&](const char* phase) { progress.begin(phase, "points"); };
  stream.end_phase = [&] { progress.end(); };
  stream.progress = [&](std::uint64_t points, std::optional<double> fraction) {
    progress.update(points, fraction);
  };
  statistics.max_edge = stream.max_edge;
  return stream;
}

void report(const TriangulateOptions& options, const RunStatistics& statistics,
            Progress& progress) {
  const StreamFigures& stream = statistics.stream;
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

/// Buffers of some megabytes come and go with every leaf: taken from the system anew each time,
/// they would cost a fifth of the run in page faults.
void reuse_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
  mallopt(M_TRIM_THRESHOLD, 16 << 20);
}

template <int D>
int run(const TriangulateOptions& options, MeshFormat format, RunStatistics& statistics) {
  const auto start = std::chrono::steady_clock::now();
  reuse_freed_memory();
  const auto& inputs = options.inputs;
  Progress progress =
      make_progress(options.report, std::count(inputs.begin(), inputs.end(), "-") > 0);
  const StreamOptions stream = stream_options(options, progress, statistics);
  MemoryBudget budget(memory_limit(options.memory));
  const auto scratch = make_scratch_folder(options.memory);
  PointSource source(disk(), options.inputs,
                     {.dimension = D,
                      .index = options.input_index,
                      .reader = options.reader,
                      .warn = [&](std::string_view text) { progress.say(text); },
                      .detail = [&](std::string_view text) { progress.detail(text); }});
  MeshStreamHeader header;
  header.dimension = D;
  header.has_input_index = options.input_index;
  header.lattice = source.lattice();
  header.points = source.count();
  header.crs = source.crs();
  header.extent = source.world_extent();
  const auto writer = open_mesh_stream_writer(disk(), options.output, format, header, *scratch);

  statistics.stream = triangulate_stream<D>(source, *writer, *scratch, budget, stream);
  if (statistics.stream.threads < stream.threads) {
    progress.detail(fmt::format("{} of {} threads used: more of them need more --memory",
                                statistics.stream.threads, stream.threads));
  }
  statistics.memory_limit = budget.limit();
  statistics.withheld = source.withheld();
  statistics.on_lattice = source.lattice().has_value();
  const MeshTotals& totals = statistics.stream.totals;
  if (totals.simplices == 0) {
    throw Error(fmt::format("every one of {} simplices has an edge longer than {}: nothing is left",
                            statistics.stream.left_out, *statistics.max_edge));
  }
  progress.begin("write", D == 2 ? "triangles" : "tetrahedra");
  writer->finish(totals);
  progress.update(totals.simplices, 1);
  statistics.write_seconds = progress.end();
  statistics.output_bytes = writer->bytes_written();

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

int run(const TriangulateOptions& options) {
  if (options.simulates()) {
    parse_core_list(options.core_list);
    if (options.threads > 1) {
      throw UsageError("--simulate-cores measures tasks on one thread: leave --threads away");
    }
  }
  if (std::count(options.inputs.begin(), options.inputs.end(), "-") > 1) {
    throw UsageError("standard input can be read only once: give - once");
  }
  if (options.output == options.stats_path) {
    throw UsageError("the mesh and --stats cannot go to the same place: " + options.output);
  }
  const MeshFormat format = mesh_format(options.output, options.output_format);
  if (options.output == "-" && ::isatty(STDOUT_FILENO) != 0 && options.output_format.empty()) {
    throw UsageError("a mesh stream is nothing for a terminal: name a file, or pipe it on");
  }
  RunStatistics statistics;
  statistics.dimension = options.dimension == "3" ? 3 : 2;
  statistics.inputs = options.inputs;
  statistics.output = options.output;
  statistics.output_format = mesh_format_names().at(static_cast<std::size_t>(format));
  if (!options.stats_path.empty()) check_can_create(disk(), options.stats_path);
  return statistics.dimension == 3 ? run<3>(options, format, statistics)
                                   : run<2>(options, format, statistics);
}

}  // namespace

Subcommand add_triangulate(CLI::App& root) {
  const auto options = std::make_shared<TriangulateOptions>();
  CLI::App* app = root.add_subcommand("triangulate", "Make a Delaunay mesh of points");
  app->footer(kExamples);
  add_options(*app, *options);
  return {app, [options] { return run(*options); }};
}

}  // namespace spillway

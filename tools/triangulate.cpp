#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/mesh_writer.h"
#include "src/delaunay/delaunay.h"
#include "src/error.h"
#include "src/geometry/canonical_hash.h"
#include "src/parallel/parallel.h"
#include "tools/command.h"
#include "tools/command_options.h"
#include "tools/core_simulation.h"
#include "tools/heights.h"
#include "tools/input_points.h"
#include "tools/json_text.h"
#include "tools/mesh_output.h"
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
    "All inputs are read into memory before the output is begun, so an output may replace an "
    "input.";

struct TriangulateOptions {
  std::vector<std::string> inputs;
  std::string output;
  std::string output_format;
  std::string dimension = "2";
  std::string duplicates = "first";
  std::string division = "longest";
  std::optional<double> max_edge;
  unsigned threads = 0;
  std::size_t base_case_size = 0;
  unsigned children = 2;
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
  app.add_option("-o,--output", options.output, "Mesh file; - is standard output")
      ->required()
      ->type_name("FILE");
  add_choice(app, "--dim", options.dimension, {"2", "3"},
             "2: triangles over x, y, with z carried along; 3: tetrahedra");
  add_choice(app, "--duplicates", options.duplicates, height_choice_names(),
             "Which z a vertex of several points of equal x, y gets");
  app.add_option("--max-edge", options.max_edge, "Leave out simplices with an edge longer than L")
      ->type_name("L")
      ->check(CLI::Validator(CLI::PositiveNumber).description(""));
  app.add_flag("--id", options.input_index, "Write each vertex's index in the input");
  add_choice(app, "--output-format", options.output_format, mesh_format_names(),
             "Format of the mesh, where the name does not tell");
  add_reader_options(app, options.reader);
  app.add_option("--threads", options.threads, "Threads to use; 0: all there are")
      ->type_name("N")
      ->check(CLI::Range(0, 4096).description(""))
      ->capture_default_str();
  app.add_option("--stats", options.stats_path, "Write figures and the task tree of the run")
      ->type_name("FILE");
  app.add_option("--base-case", options.base_case_size,
                 "Most points of one sequential base case; 0: chosen by the number of points")
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

/// Says plainly why points that do not span D dimensions have no triangulation.
template <int D>
void require_full_dimension(const Triangulation<D>& triangulation) {
  if (triangulation.dimension == D) return;
  const char* simplex = D == 2 ? "triangle" : "tetrahedron";
  const std::size_t points = triangulation.points.size();
  const std::size_t distinct = triangulation.vertex_count();
  if (points == 0) throw Error("the input has no points");
  if (distinct <= D) {
    throw Error(fmt::format("the input has only {} distinct point{}: a {} needs {}", distinct,
                            distinct == 1 ? "" : "s", simplex, D + 1));
  }
  throw Error(fmt::format("all {} points lie {}: there is no {} to make{}", points,
                          triangulation.dimension == 1 ? "on one line" : "in one plane", simplex,
                          triangulation.dimension == 2 ? " (--dim 2 makes triangles)" : ""));
}

/// Separates what is triangulated from what is carried along, and lets go of the rest.
template <int D>
std::vector<Point<D>> take_coordinates(InputPoints& input, std::vector<double>& heights) {
  if constexpr (D == 3) {
    return std::move(input.points);
  } else {
    std::vector<Point<2>> flat;
    flat.reserve(input.points.size());
    heights.reserve(input.points.size());
    for (const Point<3>& point : input.points) {
      flat.push_back({point[0], point[1]});
      heights.push_back(point[2]);
    }
    input.points = {};
    return flat;
  }
}

template <int D>
Triangulation<D> triangulate(const std::vector<Point<D>>& points, const TriangulateOptions& options,
                             RunStatistics& statistics, Progress& progress) {
  DelaunayOptions engine;
  engine.threads = statistics.threads;
  engine.base_case_size = options.base_case_size;
  engine.division = division_by_name(options.division);
  engine.children = options.children;
  engine.tasks = &statistics.tasks;
  engine.progress = [&](std::size_t done) {
    progress.update(done, static_cast<double>(done) / static_cast<double>(points.size()));
  };
  progress.begin("triangulate", "points");
  auto triangulation = delaunay<D>(std::span<const Point<D>>(points), engine);
  require_full_dimension(triangulation);
  progress.update(points.size(), 1);
  statistics.triangulate_seconds = progress.end();
  return triangulation;
}

void report(const TriangulateOptions& options, const RunStatistics& statistics,
            Progress& progress) {
  const MeshFigures& mesh = statistics.mesh;
  if (mesh.left_out > 0) {
    progress.say(
        fmt::format("{} simplices with an edge longer than {} left out: this is no longer "
                    "the Delaunay triangulation of all points",
                    mesh.left_out, *options.max_edge));
  }
  if (options.simulates()) {
    progress.say("what the triangulation alone would take, tasks measured on one thread:\n" +
                 simulation_table(statistics.simulated));
  }
  progress.say(fmt::format("{} points, {} duplicates, {} vertices, {} {}, hash {}, {:.2f} s",
                           statistics.points, statistics.duplicates, mesh.vertices, mesh.simplices,
                           statistics.dimension == 2 ? "triangles" : "tetrahedra",
                           hash_to_hex(mesh.canonical_hash), statistics.seconds));
}

template <int D>
int run(const TriangulateOptions& options, MeshFormat format, RunStatistics& statistics) {
  const auto start = std::chrono::steady_clock::now();
  Progress progress = make_progress(options.report);
  statistics.threads = options.simulates()    ? 1
                       : options.threads == 0 ? available_threads()
                                              : options.threads;

  InputPoints input = read_input_points(
      disk(), options.inputs,
      {.dimension = D, .index = options.input_index, .reader = options.reader}, progress);
  statistics.read_seconds = progress.end();
  statistics.points = input.points.size();
  statistics.withheld = input.withheld;
  statistics.on_lattice = input.lattice.has_value();

  TriangulatedPoints<D> result;
  {
    const std::vector<Point<D>> points = take_coordinates<D>(input, result.heights);
    result.triangulation = triangulate<D>(points, options, statistics, progress);
  }
  result.lattice = input.lattice;
  result.index = std::move(input.index);
  result.crs = input.crs;
  statistics.duplicates = result.triangulation.duplicates.size();
  if constexpr (D == 2) {
    choose_heights(result.triangulation, height_choice_by_name(options.duplicates), result.heights);
  }

  const char* unit = D == 2 ? "triangles" : "tetrahedra";
  const MeshSelection selection{options.max_edge};
  progress.begin("hash", unit);
  statistics.mesh = measure_mesh<D>(result, selection, statistics.threads);
  progress.update(statistics.mesh.simplices, 1);
  statistics.hash_seconds = progress.end();
  progress.begin("write", unit);
  write_mesh<D>(result, selection, statistics.mesh, disk(), options.output, format, progress);
  statistics.write_seconds = progress.end();

  if (options.simulates()) {
    statistics.simulated = simulate_cores(statistics.tasks, parse_core_list(options.core_list));
  }
  statistics.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.stats_path.empty()) {
    write_text(options.stats_path, json_text(to_json(statistics), 2) + "\n");
  }
  report(options, statistics, progress);
  return kExitDone;
}

/// Opens the outputs on trial, where nobody notices.
void try_outputs(const TriangulateOptions& options, MeshFormat format, int dimension) {
  if (!options.stats_path.empty()) check_can_create(disk(), options.stats_path);
  if (!can_be_tried(options.output)) return;
  MeshHeader header;
  header.dimension = dimension;
  header.has_input_index = options.input_index;
  open_mesh_writer(disk(), options.output, format, header);
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
  RunStatistics statistics;
  statistics.dimension = options.dimension == "3" ? 3 : 2;
  statistics.inputs = options.inputs;
  statistics.output = options.output;
  statistics.output_format = mesh_format_names().at(static_cast<std::size_t>(format));
  try_outputs(options, format, statistics.dimension);
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

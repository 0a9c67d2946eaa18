#include <fmt/format.h>
#include <spillway/check.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "formats/meshes/mesh_formats.h"
#include "formats/points/point_formats.h"
#include "src/geometry/canonical_hash.h"
#include "src/geometry/simplex_name.h"
#include "src/parallel/most_threads.h"
#include "tools/commands/command.h"
#include "tools/commands/run_statistics.h"
#include "tools/options/command_options.h"
#include "tools/options/input_options.h"
#include "tools/report/json_text.h"
#include "tools/report/printable_text.h"
#include "tools/report/text_output.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway check tin.ply\n"
    "  spillway check tin.ply --points north.las south.las\n"
    "  spillway check of-another-program.obj --any-delaunay\n"
    "  spillway triangulate survey.las -o - | spillway check -\n"
    "A mesh stream ({}) is proved while it is read, in memory for its open border only.\n"
    "Exit code 0: proved. 1: refuted, with the first offending simplices, or not readable.";

struct CheckCommandOptions {
  const CommandLine* app = nullptr;
  std::string mesh;
  std::string mesh_format;
  std::vector<std::string> points;
  bool any_delaunay = false;
  bool json = false;
  unsigned threads = 0;
  MemoryOptions memory;
  InputOptions input;
  ReportOptions report;
};

/// A mesh's report, and what else the command says of it.
struct Outcome {
  CheckReport report;
  int dimension;
};

Outcome check_input(const CheckCommandOptions& options, ProgressLine& progress) {
  // Memory is for the points alone.
  const MemoryOptions memory = options.points.empty() ? MemoryOptions{} : options.memory;
  const Context context(context_options(memory, options.threads, progress));
  const auto mesh = open_mesh(
      options.mesh, {.format = options.mesh_format, .max_expansion = options.input.max_expansion},
      context);
  const int dimension = mesh->header().dimension;
  std::unique_ptr<PointSource> points;
  if (!options.points.empty()) {
    points = open_points(options.points, point_options(options.input, dimension), context);
  }
  Outcome outcome{check(*mesh, {.any_delaunay = options.any_delaunay}, context, points.get()),
                  dimension};
  const PointCounts& counts = outcome.report.points;
  if (!counts.all_kept()) progress.say(describe(counts));
  return outcome;
}

Json json_report(const Outcome& outcome, const CheckCommandOptions& options) {
  const CheckReport& report = outcome.report;
  Json json;
  json["name"] = options.mesh;
  json["proved"] = report.fault_count == 0;
  json["dimension"] = outcome.dimension;
  json["vertices"] = report.vertices;
  json["simplices"] = report.simplices;
  json["hull_facets"] = report.hull_facets;
  json["canonical_hash"] = hash_to_hex(report.canonical_hash);
  json["on_lattice"] = report.on_lattice;
  json["peak_live_vertices"] = report.peak_live_vertices;
  json["peak_open_facets"] = report.peak_open_facets;
  json["properties"] = report.proved;
  json["fault_count"] = report.fault_count;
  json["other_ties"] = report.other_ties;
  json["faults"] = report.faults;
  return json;
}

/// What points and meshes are rounded in.
std::vector<std::string> rounding_formats() {
  std::vector<std::string> names;
  for (const PointFormat* const format : point_formats()) {
    if (format->is_text) names.emplace_back(format->name);
  }
  const auto rounds = [](const MeshFormat& format) { return format.rounds_coordinates; };
  std::ranges::move(names_of_formats(rounds), std::back_inserter(names));
  return names;
}

const char* facets_text(int dimension, std::uint64_t count) {
  if (dimension == 2) return count == 1 ? "edge" : "edges";
  return count == 1 ? "facet" : "facets";
}

std::string text_report(const Outcome& outcome, const CheckCommandOptions& options) {
  const CheckReport& report = outcome.report;
  std::string text;
  for (const std::string& line : report.proved) text += "proved: " + line + "\n";
  for (const std::string& line : report.faults) text += "fault: " + printable(line) + "\n";
  if (report.fault_count > report.faults.size()) {
    text += fmt::format("fault: {} more\n", report.fault_count - report.faults.size());
  }
  if (report.off_lattice > 0) {
    text += fmt::format(
        "hint: vertices off the lattice are what rounding leaves ({}); check without --points, or "
        "make the mesh of LAS or spp\n",
        fmt::join(rounding_formats(), ", "));
  }
  text += fmt::format("{} vertices, {} {}, {} hull facets, hash {}\n", report.vertices,
                      report.simplices, simplices_of(outcome.dimension), report.hull_facets,
                      hash_to_hex(report.canonical_hash));
  const char* const points = options.points.empty() ? "its vertices" : "the input's points";
  if (report.other_ties > 0 && report.other_ties == report.fault_count) {
    return text + fmt::format(
                      "{}: a Delaunay triangulation of {}, but NOT the one in which ties are "
                      "broken as Spillway does: {} {} between {} vertices differ{}; "
                      "--any-delaunay accepts that\n",
                      printable(options.mesh), points, report.other_ties,
                      facets_text(outcome.dimension, report.other_ties),
                      outcome.dimension == 2 ? "cocircular" : "cospherical",
                      report.other_ties == 1 ? "s" : "");
  }
  return text + fmt::format("{}: {} Delaunay triangulation of {}\n", printable(options.mesh),
                            report.fault_count > 0 ? "NOT the"
                            : options.any_delaunay ? "proved to be a"
                                                   : "proved to be the",
                            points);
}

int run(const CheckCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::string> inputs = options.points;
  inputs.push_back(options.mesh);
  check_figures_file(options.report, inputs, "-", "the report");
  if (options.points.empty()) {
    refuse_given(*options.app, kPointOptionNames, "without --points");
  }
  ProgressLine progress = make_progress(options.report);
  const Outcome outcome = check_input(options, progress);
  const Json json = json_report(outcome, options);
  write_text("-", options.json ? json_text(json) + "\n" : text_report(outcome, options));
  write_figures(options.report, json, start);
  return outcome.report.fault_count == 0 ? kExitDone : kExitFailed;
}

}  // namespace

Subcommand add_check(CommandLine& root) {
  const auto options = std::make_shared<CheckCommandOptions>();
  CommandLine& app = root.add_subcommand("check", "Prove that a mesh is a Delaunay triangulation");
  options->app = &app;
  const auto is_stream = [](const MeshFormat& format) { return format.is_stream(); };
  app.set_footer(
      fmt::format(fmt::runtime(kExamples), fmt::join(names_of_formats(is_stream), ", ")));
  app.add_option("MESH", options->mesh, "Mesh file; - is a mesh stream from a pipe").required();
  app.add_option("--points", options->points,
                 "Prove, too, that the vertices are the distinct points of these files, in the "
                 "plane by x and y, with heights that these have")
      .value_name("FILE");
  app.add_flag("--any-delaunay", options->any_delaunay,
               "Accept either way of splitting cocircular facets, for meshes of other programs");
  app.add_flag("--json", options->json, "Print the report as one JSON object");
  add_choice(app, "--mesh-format", options->mesh_format, mesh_format_names(),
             "Format of the mesh, where the name does not tell");
  take_whole_number(app.add_option("--threads", options->threads,
                                   "Threads to prove a mesh stream with; 0: all there are"),
                    0, kMostThreads)
      .value_name("N")
      .group(kResourceGroup)
      .show_default();
  add_memory_options(app, options->memory);
  add_input_options(app, options->input);
  app.remove_option("--skip-broken");  // a proof of some of the points would be none
  app.remove_option("--crs");          // points and mesh are compared by their coordinates
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }};
}

}  // namespace spillway::command

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "formats/mesh_reader.h"
#include "formats/mesh_writer.h"
#include "src/geometry/canonical_hash.h"
#include "tools/checker.h"
#include "tools/command.h"
#include "tools/command_options.h"
#include "tools/input_points.h"
#include "tools/json_text.h"
#include "tools/text_output.h"

namespace spillway {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway check tin.ply\n"
    "  spillway check tin.ply --points north.las south.las\n"
    "  spillway check of-another-program.obj --any-delaunay\n"
    "Exit code 0: proved. 1: refuted, with the first offending simplices, or not readable.";

struct CheckCommandOptions {
  std::string mesh;
  std::string mesh_format;
  std::vector<std::string> points;
  bool any_delaunay = false;
  bool json = false;
  PointReaderOptions reader;
  ReportOptions report;
};

CheckReport check(const Mesh& mesh, const CheckCommandOptions& options, Progress& progress) {
  CheckOptions how;
  how.any_delaunay = options.any_delaunay;
  InputPoints input;
  if (!options.points.empty()) {
    input =
        read_input_points(disk(), options.points,
                          {.dimension = mesh.header.dimension, .reader = options.reader}, progress);
    progress.end();
    how.input_lattice = input.lattice;
  }
  progress.begin("check", "simplices");
  CheckReport report = check_mesh(mesh, how);
  if (!options.points.empty()) {
    if (input.lattice) {
      for (Point<3>& point : input.points) {
        for (int k = 0; k < mesh.header.dimension; ++k) {
          point[k] = input.lattice->to_world(k, point[k]);
        }
      }
    }
    check_vertex_set(mesh, input.points, report, how);
  }
  progress.update(report.simplices, 1);
  progress.end();
  return report;
}

std::string json_report(const CheckReport& report, const CheckCommandOptions& options,
                        int dimension) {
  nlohmann::ordered_json json;
  json["name"] = options.mesh;
  json["proved"] = report.faults.empty();
  json["dimension"] = dimension;
  json["vertices"] = report.vertices;
  json["simplices"] = report.simplices;
  json["hull_facets"] = report.hull_facets;
  json["canonical_hash"] = hash_to_hex(report.canonical_hash);
  json["on_lattice"] = report.on_lattice;
  json["properties"] = report.proved;
  json["fault_count"] = report.fault_count;
  json["faults"] = report.faults;
  return json_text(json) + "\n";
}

std::string text_report(const CheckReport& report, const CheckCommandOptions& options,
                        int dimension) {
  std::string text;
  for (const std::string& line : report.proved) text += "proved: " + line + "\n";
  for (const std::string& line : report.faults) text += "fault: " + line + "\n";
  if (report.fault_count > report.faults.size()) {
    text += fmt::format("fault: {} more\n", report.fault_count - report.faults.size());
  }
  text += fmt::format("{} vertices, {} {}, {} hull facets, hash {}\n", report.vertices,
                      report.simplices, dimension == 2 ? "triangles" : "tetrahedra",
                      report.hull_facets, hash_to_hex(report.canonical_hash));
  return text + fmt::format("{}: {} Delaunay triangulation of {}\n", options.mesh,
                            !report.faults.empty() ? "NOT the"
                            : options.any_delaunay ? "proved to be a"
                                                   : "proved to be the",
                            options.points.empty() ? "its vertices" : "the input's points");
}

int run(const CheckCommandOptions& options) {
  Progress progress = make_progress(options.report);
  progress.begin("read mesh", "simplices");
  const Mesh mesh = read_mesh(disk(), options.mesh, options.mesh_format);
  progress.update(mesh.corners.size() / mesh.corners_per_simplex(), 1);
  progress.end();
  const CheckReport report = check(mesh, options, progress);
  write_text("-", options.json ? json_report(report, options, mesh.header.dimension)
                               : text_report(report, options, mesh.header.dimension));
  return report.faults.empty() ? kExitDone : kExitFailed;
}

}  // namespace

Subcommand add_check(CLI::App& root) {
  const auto options = std::make_shared<CheckCommandOptions>();
  CLI::App* app = root.add_subcommand("check", "Prove that a mesh is a Delaunay triangulation");
  app->footer(kExamples);
  app->add_option("MESH", options->mesh, "Mesh file")->required();
  app->add_option("--points", options->points,
                  "Prove, too, that the vertices are the distinct points of these files")
      ->type_name("FILE");
  app->add_flag("--any-delaunay", options->any_delaunay,
                "Accept either way of splitting cocircular facets, for meshes of other programs");
  app->add_flag("--json", options->json, "Print the report as one JSON object");
  add_choice(*app, "--mesh-format", options->mesh_format, mesh_format_names(),
             "Format of the mesh, where the name does not tell");
  add_reader_options(*app, options->reader);
  add_report_options(*app, options->report);
  return {app, [options] { return run(*options); }};
}

}  // namespace spillway

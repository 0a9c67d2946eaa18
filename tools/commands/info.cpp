#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/inputs/input_kind.h"
#include "formats/inputs/open_mesh.h"
#include "formats/inputs/open_mesh_stream.h"
#include "formats/meshes/common/mesh_stream.h"
#include "src/error.h"
#include "src/geometry/canonical_hash.h"
#include "src/geometry/lattice_check.h"
#include "stream/checker/checker.h"
#include "stream/source/input_list.h"
#include "tools/commands/command.h"
#include "tools/commands/facet_count.h"
#include "tools/options/command_options.h"
#include "tools/options/input_options.h"
#include "tools/process/rank_job.h"
#include "tools/report/json_text.h"
#include "tools/report/printable_text.h"
#include "tools/report/statistics.h"
#include "tools/report/text_output.h"

namespace spillway::detail {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway info survey.las\n"
    "  spillway info *.las tin.ply --json | jq .canonical_hash\n"
    "  spillway generate terrain -n 1e8 | spillway triangulate - -o - | spillway info -\n"
    "All points are read, so extents and counts are exact, whatever headers say.";

struct InfoOptions {
  const CommandLine* app = nullptr;
  std::vector<std::string> files;
  bool json = false;
  InputOptions input;
  MemoryOptions memory;
  ReportOptions report;
};

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

/// Lowest and highest coordinates, the first `coordinates` of them.
Json extent_json(const Box<3>& box, int coordinates) {
  if (box.empty()) return nullptr;
  return {{"min", std::vector<double>(box.lo.begin(), box.lo.begin() + coordinates)},
          {"max", std::vector<double>(box.hi.begin(), box.hi.begin() + coordinates)}};
}

void add_lattice(const std::optional<Lattice>& lattice, Json& json) {
  json["scale"] = lattice ? Json(lattice->scale) : Json(nullptr);
  json["offset"] = lattice ? Json(lattice->offset) : Json(nullptr);
}

/// Points per square unit of the extent in x, y; null where that has no area.
Json density(const Box<3>& box, std::uint64_t points) {
  if (box.empty()) return nullptr;
  const double area = (box.hi[0] - box.lo[0]) * (box.hi[1] - box.lo[1]);
  return area > 0 ? Json(static_cast<double>(points) / area) : Json(nullptr);
}

Json describe_points(ProbedInput& input, const InfoOptions& options, Progress& progress) {
  const auto scratch = make_scratch_folder(options.memory);
  const auto source =
      make_point_source(input, {input.path()}, options.input,
                        {.memory = memory_limit(options.memory)}, *scratch, progress);
  const PointHeader header = source->headers().front();
  const std::optional<Lattice>& lattice = source->lattice();
  Box<3> box;
  std::uint64_t points = 0;
  PointBlock block;
  progress.begin("read", "points");
  while (source->read(block)) {
    for (const Point<3>& point : block.points) {
      box.expand(lattice ? lattice->to_world(point) : point);
    }
    points += block.size();
    progress.update(source->points_read(), source->fraction_read());
  }
  progress.end(source->points_read());
  const PointCounts counts = source->counts();
  Json json;
  json["name"] = header.name;
  json["kind"] = "points";
  json["format"] = header.format;
  json["version"] = text_or_null(header.version);
  json["point_format"] = header.point_format < 0 ? Json(nullptr) : Json(header.point_format);
  json["coordinates"] = header.coordinates;
  json["points"] = points;
  json["withheld"] = counts.withheld;
  json["filters"] = options.input.filters() ? to_json(counts) : Json(nullptr);
  json["extent"] = extent_json(box, header.coordinates);
  add_lattice(header.lattice, json);
  json["density"] = density(box, points);
  json["crs"] = text_or_null(header.crs);
  json["crs_note"] = text_or_null(header.crs_note);
  json["software"] = text_or_null(header.software);
  return json;
}

/// What there is to say of a mesh, however it came.
struct MeshFigures {
  std::string format;
  std::uint64_t vertices;
  std::uint64_t simplices;
  std::uint64_t hull_facets;
  std::uint64_t hash;
  Box<3> extent;
};

/// `header` is a MeshHeader or a MeshStreamHeader.
template <typename Header>
Json mesh_json(const std::string& path, const Header& header, const MeshFigures& figures) {
  Json json;
  json["name"] = path;
  json["kind"] = "mesh";
  json["format"] = text_or_null(figures.format);
  json["dimension"] = header.dimension;
  json["vertices"] = figures.vertices;
  json["simplices"] = figures.simplices;
  json["hull_facets"] = figures.hull_facets;
  json["canonical_hash"] = hash_to_hex(figures.hash);
  json["extent"] = extent_json(figures.extent, 3);
  add_lattice(header.lattice, json);
  json["on_lattice"] = header.lattice.has_value();
  json["input_index"] = header.has_input_index;
  json["crs"] = text_or_null(header.crs);
  return json;
}

Json describe_mesh(ProbedInput& input, Progress& progress) {
  progress.begin("read", "vertices");
  const Mesh mesh = read_mesh(input, input.path());
  progress.end(mesh.vertices.size());
  const std::string extension = std::filesystem::path(input.path()).extension().string();
  return mesh_json(input.path(), mesh.header,
                   {.format = extension.empty() ? extension : extension.substr(1),
                    .vertices = mesh.vertices.size(),
                    .simplices = mesh.corners.size() / mesh.corners_per_simplex(),
                    .hull_facets = count_boundary_facets(mesh),
                    .hash = canonical_hash(mesh),
                    .extent = box_around(mesh.vertices)});
}

/// Holds no more of the stream than its open border. Throws Error if its end says otherwise than
/// what was read.
Json describe_mesh_stream(ProbedInput& input, Progress& progress) {
  const MeshFormat& format = mesh_stream_format(input.source(), input.path());
  const auto reader = open_mesh_stream_reader(input, input.path());
  Box<3> box;
  CheckOptions options;
  options.vertex = [&box](const Point<3>& vertex) { box.expand(vertex); };
  options.progress = [&progress](std::uint64_t simplices, std::optional<double> fraction) {
    progress.update(simplices, fraction);
  };
  progress.begin("read", "simplices");
  const CheckReport found = count_mesh_stream(*reader, options);
  progress.end(found.simplices);
  if (found.fault_count > 0) {
    throw Error(fmt::format("{}: {}; the file is corrupt, write it again", input.path(),
                            found.faults.front()));
  }
  Json json = mesh_json(input.path(), reader->header(),
                        {.format = std::string(format.name),
                         .vertices = found.vertices,
                         .simplices = found.simplices,
                         .hull_facets = found.hull_facets,
                         .hash = found.canonical_hash,
                         .extent = box});
  if (reader->has_hash()) {
    json["points"] = reader->totals().points;
    json["duplicates"] = reader->totals().duplicates;
  }
  json["peak_live_vertices"] = found.peak_live_vertices;
  return json;
}

InputKind kind_of(ProbedInput& input, const InfoOptions& options) {
  const bool told = !options.input.format.empty() && input.is_pipe();
  return told ? InputKind::kPoints : kind_of_input(input);
}

Json describe_input(ProbedInput& input, const InfoOptions& options, Progress& progress) {
  switch (kind_of(input, options)) {
    case InputKind::kMesh:
      return describe_mesh(input, progress);
    case InputKind::kMeshStream:
      return describe_mesh_stream(input, progress);
    case InputKind::kPoints:
      break;
  }
  return describe_points(input, options, progress);
}

std::string value_text(const Json& value) {
  if (value.is_null()) return "-";
  if (value.is_text()) return printable(value.text());
  if (value.is_float()) return fmt::format("{:.15g}", value.number());
  if (!value.is_array()) return json_text(value);
  std::string text;
  for (const Json& item : value.elements()) {
    if (!text.empty()) text += "  ";
    text += value_text(item);
  }
  return text;
}

/// The same keys and values as the JSON, laid out for people: no more digits than mean something.
std::string describe(const Json& json) {
  std::string text = printable(json.find("name")->text()) + "\n";
  for (const auto& [key, value] : json.members()) {
    if (key == "name") continue;
    if (value.is_object()) {
      for (const auto& [inner_key, inner_value] : value.members()) {
        const std::string path = fmt::format("{} {}", key, inner_key);
        text += fmt::format("  {:16} {}\n", path, value_text(inner_value));
      }
    } else {
      const bool estimate = key == "density" && value.is_number();
      text += fmt::format("  {:16} {}\n", key,
                          estimate ? fmt::format("{:.6g}", value.number()) : value_text(value));
    }
  }
  return text;
}

/// Adds what the JSON of every kind of file has in common with that of --stats; null where the file
/// does not tell.
void add_common_keys(double seconds, Json& json) {
  for (const char* key :
       {"points", "duplicates", "vertices", "simplices", "hull_facets", "canonical_hash"}) {
    if (!json.contains(key)) json[key] = nullptr;
  }
  json["peak_rss_bytes"] = peak_rss_bytes();
  json["seconds"] = seconds;
}

void tell(ProbedInput& input, const InfoOptions& options, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  Json json = describe_input(input, options, progress);
  if (options.json) {
    add_common_keys(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                    json);
  }
  write_text("-", options.json ? json_text(json) + "\n" : describe(json));
}

/// Whether an input is points, or cannot be looked at, which is told in its turn.
bool may_be_points(ProbedInput& input, const InfoOptions& options) {
  try {
    return kind_of(input, options) == InputKind::kPoints;
  } catch (const Error&) {
    return true;
  }
}

/// One for each path that has been looked at.
using Inputs = std::map<std::string, ProbedInput>;

ProbedInput& input_of(const std::string& path, Inputs& inputs) {
  return inputs.try_emplace(path, disk(), path).first->second;
}

/// Throws UsageError if there are options for points, and no points. What is read of pipes for that
/// stays with `inputs`.
void check_point_options(const std::vector<std::string>& paths, const InfoOptions& options,
                         Inputs& inputs) {
  const bool points = std::ranges::any_of(paths, [&](const std::string& path) {
    ProbedInput& input = input_of(path, inputs);
    const bool found = may_be_points(input, options);
    input.release();
    return found;
  });
  if (points) return;
  refuse_given(*options.app, kInputOptionNames,
               paths.size() == 1 ? fmt::format("on {}, which is a mesh", paths.front())
                                 : "on these files, which are meshes");
}

int run(const InfoOptions& options) {
  Progress progress = make_progress(
      options.report, std::count(options.files.begin(), options.files.end(), "-") > 0);
  const auto paths =
      expand_inputs(options.files, [&](std::string_view text) { progress.say(text); });
  Inputs inputs;
  if (!given_options(*options.app, kInputOptionNames).empty()) {
    check_point_options(paths, options, inputs);
  }
  int exit_code = kExitDone;
  for (const std::string& path : paths) {
    try {
      tell(input_of(path, inputs), options, progress);
    } catch (const InvalidArgument&) {
      throw;
    } catch (const ClosedPipe&) {
      throw;
    } catch (const Error& error) {
      // What else there is to tell is not held up by one file.
      progress.give_up();
      if (paths.size() == 1) throw;
      exit_code = report_error(error, kExitFailed);
    }
    inputs.erase(path);
  }
  return exit_code;
}

}  // namespace

Subcommand add_info(CommandLine& root) {
  const auto options = std::make_shared<InfoOptions>();
  CommandLine& app = root.add_subcommand("info", "Tell what point files and meshes hold");
  options->app = &app;
  app.set_footer(kExamples);
  app.add_option("FILE", options->files,
                 "Point files and meshes; - is points or a mesh stream from a pipe")
      .required();
  app.add_flag("--json", options->json, "One JSON object a line for each file");
  add_input_options(app, options->input);
  app.remove_option("--force-crs");  // each file is told of for itself
  add_memory_options(app, options->memory);
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }};
}

}  // namespace spillway::detail

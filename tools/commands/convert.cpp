#include <fmt/format.h>
#include <spillway/convert.h>
#include <spillway/input.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/meshes/mesh_formats.h"
#include "formats/points/create_points.h"
#include "src/error.h"
#include "src/geometry/canonical_hash.h"
#include "src/runtime/process_memory.h"
#include "tools/commands/command.h"
#include "tools/commands/run_statistics.h"
#include "tools/commands/skipped_inputs.h"
#include "tools/commands/tile_files.h"
#include "tools/options/command_options.h"
#include "tools/options/input_options.h"
#include "tools/options/point_output.h"
#include "tools/options/triangulation_options.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway convert tile.laz -o tile.las\n"
    "  spillway convert 'tiles/*.laz' -o ground.spp --keep-class 2\n"
    "  spillway convert survey.xyz.gz -o survey.las --scale 0.01\n"
    "  spillway convert tile.laz -o tile.csv --attributes class,intensity\n"
    "  spillway convert 'tiles/*.laz' --sorted -o - | spillway triangulate - -o tin.spm\n"
    "  spillway convert tin.spm -o tin.ply\n"
    "  spillway convert tin.spm -o 'tin_{x}_{y}.ply' --tiles 1000\n"
    "  spillway triangulate survey.las -o - | spillway convert - -o tin.obj\n"
    "Points and spm streams are converted as they come, in little memory; other meshes are read as "
    "a whole. Sorted points are all read first, within the memory limit.";

struct ConvertCommandOptions {
  const CommandLine* app = nullptr;
  std::vector<std::string> inputs;
  InputOptions input;
  std::string mesh_format;
  PointOutput output;
  std::vector<double> scale;   ///< none, one for all axes, or three
  std::vector<double> offset;  ///< likewise
  std::string attributes;      ///< names and commas, "all", "none"; empty: as the format has them
  std::string tiles;           ///< of a mesh
  bool sorted = false;
  bool force = false;
  SortOptions sorting;
  MemoryOptions memory;
  ReportOptions report;
};

/// The words of --output-format: formats of points and of meshes.
std::vector<std::string> output_format_names() {
  std::vector<std::string> names = written_point_format_names();
  const std::vector<std::string> meshes = mesh_format_names();
  std::erase_if(names, [&](const std::string& name) {
    return std::ranges::find(meshes, name) != meshes.end();
  });
  names.insert(names.end(), meshes.begin(), meshes.end());
  return names;
}

/// Several inputs, and what stands for several, are points.
InputKind kind_of(const ConvertCommandOptions& options, const Context& context) {
  if (!options.mesh_format.empty()) return InputKind::kMesh;
  const std::string& input = options.inputs.front();
  if (!options.input.format.empty() || options.inputs.size() > 1 || stands_for_several(input)) {
    return InputKind::kPoints;
  }
  return kind_of_input(input, context);
}

bool is_mesh_output(const PointOutput& output) {
  try {
    mesh_format(output.path, output.format);
    return true;
  } catch (const InvalidArgument&) {
    return false;
  }
}

/// Throws if the output is of no point format, or bytes would go to a terminal.
void check_points_output(const ConvertCommandOptions& options) {
  const PointOutput& output = options.output;
  const bool piped = output.path == "-" && output.format.empty();
  const PointFormat* format = &own_point_stream();
  try {
    if (!piped) format = &point_format_to_write(output.path, output.format);
  } catch (const InvalidArgument&) {
    if (!is_mesh_output(output)) throw;
    throw Failure(
        fmt::format("{}: these are points, and {} would be a mesh: use spillway triangulate",
                    options.inputs.front(), output.name()));
  }
  check_las_version(output, format->has_versions);
  if (options.sorted && !format->holds_regions) {
    throw UsageError(fmt::format("--sorted is for spp, and {} is {}: leave it out, or write spp",
                                 output.name(), format->title));
  }
  static_cast<void>(format_name_of(output));
}

/// "0.001", or "0.01, 0.01, 0.001" if the axes differ.
std::string axes_text(const std::array<double, 3>& values) {
  if (values[0] == values[1] && values[1] == values[2]) return fmt::format("{}", values[0]);
  return fmt::format("{}, {}, {}", values[0], values[1], values[2]);
}

/// Says what is not as it was in the inputs.
void tell_changes(const PointConversion& done, ProgressLine& progress) {
  if (done.farthest > 0) {
    progress.say(fmt::format(
        "coordinates rounded to multiples of {} from {} on, which moved them by {:.3g} at most; "
        "--scale and --offset choose others",
        axes_text(done.scale), axes_text(done.offset), done.farthest));
  }
  if (done.adds_heights) progress.say("the points have no z: in LAS it is 0");
  if (!done.lost.empty()) progress.say(fmt::format("not kept: {}", fmt::join(done.lost, ", ")));
  if (!done.points.all_kept()) progress.say(describe(done.points));
}

Json figures_of(const ConvertCommandOptions& options, const PointConversion& done) {
  return {{"inputs", options.inputs},
          {"output", options.output.path},
          {"points", done.written},
          {"filters", to_json(done.points)},
          {"skipped_files", to_json(done.skipped_files)},
          {"lost", done.lost},
          {"farthest", done.farthest},
          {"cells", done.cells},
          {"spilled_points", done.spilled_points},
          {"spilled_bytes", done.spilled_bytes}};
}

Json figures_of(const ConvertCommandOptions& options, const Report& report) {
  return {{"inputs", options.inputs},
          {"output", options.output.path},
          {"output_files", report.output_files},
          {"outside_tiles", report.outside_tiles},
          {"outside_vertices", report.outside_vertices},
          {"points", report.mesh.points},
          {"duplicates", report.mesh.duplicates},
          {"vertices", report.mesh.vertices},
          {"simplices", report.mesh.simplices},
          {"hull_facets", report.mesh.hull_facets},
          {"canonical_hash", hash_to_hex(report.mesh.canonical_hash)},
          {"lost", report.lost}};
}

int run_points(const ConvertCommandOptions& options, const Context& context, ProgressLine& progress,
               std::chrono::steady_clock::time_point start) {
  refuse_given(*options.app, {"--tiles"}, "on points: a mesh is cut into tiles");
  check_points_output(options);
  const PointOutput& output = options.output;
  PointFileOptions written{.format = format_name_of(output),
                           .las_version = output.las_version,
                           .scale = options.scale,
                           .offset = options.offset,
                           .force = options.force,
                           .attributes = attribute_names(options.attributes)};
  if (options.sorted) {
    written.sorted = options.sorting;
    reuse_freed_memory(std::size_t{4} << 20);
  }
  const auto file = create_points(output.path, written, context);
  PointOptions how = point_options(options.input, options.sorted ? 2 : 0);
  how.metadata = true;
  const auto points = open_points(options.inputs, how, context);
  const PointConversion done = convert(*points, *file, context);
  write_figures(options.report, figures_of(options, done), start);
  tell_changes(done, progress);
  progress.detail(fmt::format("peak memory {} bytes", peak_memory()));
  if (!options.sorted) {
    progress.say(fmt::format("{} points in {}", done.written, output.name()));
    return tell_skipped(done.skipped_files, progress);
  }
  if (done.spilled_points > 0) {
    progress.detail(fmt::format("{} points written to scratch files, {} bytes", done.spilled_points,
                                done.spilled_bytes));
  }
  progress.say(fmt::format("{} points in {}, sorted in {} cell{}", done.written, output.name(),
                           done.cells, done.cells == 1 ? "" : "s"));
  return tell_skipped(done.skipped_files, progress);
}

/// Throws if the output is of a point format, and of no mesh format.
void check_mesh_output(const ConvertCommandOptions& options) {
  const PointOutput& output = options.output;
  if (is_mesh_output(output)) return;
  try {
    point_format_to_write(output.path, format_name_of(output));
  } catch (const InvalidArgument&) {
    return;  // of neither: that is said when the mesh is written
  }
  throw UsageError(
      fmt::format("{}: this is a mesh, and {} would be points: convert the points it was made of",
                  options.inputs.front(), output.name()));
}

/// What a mesh was written to, in words.
std::string files_of(const std::string& output, const MeshFormat& format) {
  if (output == "-") return "standard output";
  return format.file_set != nullptr ? format.file_set->names(output) : output;
}

void run_mesh(const ConvertCommandOptions& options, const Context& context, ProgressLine& progress,
              std::chrono::steady_clock::time_point start) {
  const std::string& input = options.inputs.front();
  if (options.inputs.size() > 1) {
    throw UsageError("several meshes do not become one: convert them one by one");
  }
  std::vector<std::string_view> of_points(kPointOptionNames.begin(), kPointOptionNames.end());
  const TileChoice tiles = parse_tiles(options.tiles);
  std::erase_if(of_points, [](auto name) { return name.starts_with("--clip"); });
  if (!options.input.crs.empty() || !tiles.polygons.empty() || !options.input.clip.empty()) {
    std::erase_if(of_points, [](auto name) { return name == "--crs" || name == "--force-crs"; });
  }
  of_points.insert(of_points.end(), {"--scale", "--offset", "--force", "--las-version", "--sorted",
                                     "--cell-points", "--dim"});
  refuse_given(*options.app, of_points, fmt::format("on {}, which is a mesh", input));
  check_mesh_output(options);
  if (options.tiles.empty()) refuse_pattern(options.output.path);
  const PointOutput& output = options.output;
  const MeshFormat& format = mesh_format(output.path, output.format);
  if (output.path == "-" && ::isatty(STDOUT_FILENO) != 0 && output.format.empty()) {
    throw UsageError("a mesh stream cannot go to a terminal: name a file, or pipe it on");
  }
  const auto mesh = open_mesh(input, mesh_options(options.input, options.mesh_format), context);
  const auto file = create_mesh(output.path,
                                {.format = output.format,
                                 .attributes = attribute_names(options.attributes),
                                 .tile_side = tiles.side,
                                 .tile_polygons = tiles.polygons,
                                 .clip = clip_of(options.input),
                                 .foreign_crs = options.input.force_crs},
                                context);
  const Report report = convert(*mesh, *file, context);
  write_figures(options.report, figures_of(options, report), start);
  const MeshTotals& totals = report.mesh;
  if (!report.lost.empty()) progress.say(fmt::format("not kept: {}", fmt::join(report.lost, ", ")));
  if (!options.input.clip.empty()) say_clipped(report, progress);
  if (!options.tiles.empty()) say_mesh_tiles(report, output.path, progress);
  progress.say(fmt::format("{} vertices, {} simplices in {}", totals.vertices, totals.simplices,
                           files_of(output.path, format)));
  const std::string note = rounding_note(format, output.path);
  if (!note.empty()) progress.say(note);
}

/// One number for all axes, or one each.
void check_axes(std::string_view option, const std::vector<double>& values) {
  if (values.size() == 2 || values.size() > 3) {
    throw UsageError(fmt::format("{}: give one number, or three for x, y and z", option));
  }
}

int run(const ConvertCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check_figures_file(options.report, options.inputs, options.output.path, "the output");
  check_axes("--scale", options.scale);
  check_axes("--offset", options.offset);
  if (!options.sorted) {
    refuse_given(*options.app, {"--cell-points", "--dim"}, "without --sorted");
  }
  ProgressLine progress = make_progress(options.report, options.output.path);
  const Context context(context_options(options.memory, 0, progress));
  if (kind_of(options, context) == InputKind::kPoints) {
    return run_points(options, context, progress, start);
  }
  run_mesh(options, context, progress, start);
  return kExitDone;
}

}  // namespace

Subcommand add_convert(CommandLine& root) {
  const auto options = std::make_shared<ConvertCommandOptions>();
  CommandLine& app = root.add_subcommand("convert", "Write points or a mesh in another format");
  options->app = &app;
  app.set_footer(kExamples);
  app.add_option(
         "IN", options->inputs,
         "Point files, folders, 'patterns', @lists, which become one, or a mesh; - is a pipe")
      .required();
  app.add_option("-o,--output", options->output.path, "Point file or mesh; - is standard output")
      .required()
      .value_name("FILE");
  add_choice(app, "--output-format", options->output.format, output_format_names(),
             "Format of the output, where the name does not tell");
  add_tiles(app, options->tiles,
            "Of a mesh, a file for each square of this side, or each polygon of a file");
  add_choice(app, "--mesh-format", options->mesh_format, mesh_format_names(),
             "The input is a mesh of this format, if neither content nor name tell it");
  add_las_version(app, options->output);
  add_number_list(app, "--scale", options->scale,
                  "Round coordinates to multiples of this; one number, or one for each axis", true)
      .value_name("N[,N,N]");
  add_number_list(app, "--offset", options->offset, "Count these multiples from here on; likewise")
      .value_name("N[,N,N]");
  add_attributes(app, options->attributes,
                 "Attributes to write [all; none of text other than CSV]");
  app.add_flag("--force", options->force, "Replace an input, though the output holds less than it");
  app.add_flag("--sorted", options->sorted,
               "Write the points cell by cell, so that their reader can begin at once");
  take_whole_number(app.add_option("--cell-points", options->sorting.cell_points,
                                   "Most points of a cell; usually 65536")
                        .value_name("N"),
                    1);
  add_dimension(app, options->sorting.dimension,
                "Cells that divide the plane, or space, for tetrahedra");
  add_input_options(app, options->input);
  add_memory_options(app, options->memory);
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }};
}

}  // namespace spillway::command

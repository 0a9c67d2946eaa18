#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/inputs/input_kind.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/points/create_points.h"
#include "stream/source/input_list.h"
#include "tools/commands/command.h"
#include "tools/commands/convert_meshes.h"
#include "tools/commands/convert_points.h"
#include "tools/options/command_options.h"
#include "tools/options/input_options.h"
#include "tools/report/usage_error.h"

namespace spillway::detail {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway convert tile.laz -o tile.las\n"
    "  spillway convert 'tiles/*.laz' -o ground.spp --keep-class 2\n"
    "  spillway convert survey.xyz.gz -o survey.las --scale 0.01\n"
    "  spillway convert tin.spm -o tin.ply\n"
    "  spillway triangulate survey.las -o - | spillway convert - -o tin.obj\n"
    "Points and spm streams are converted as they come, in little memory; other meshes are read as "
    "a whole.";

struct ConvertOptions {
  const CommandLine* app = nullptr;
  std::vector<std::string> inputs;
  InputOptions input;
  std::string mesh_format;
  PointOutput output;
  LatticeChoice lattice;
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
InputKind kind_of(const ConvertOptions& options, ProbedInput& input) {
  if (!options.mesh_format.empty()) return InputKind::kMesh;
  if (!options.input.format.empty() || options.inputs.size() > 1 ||
      stands_for_several(input.path())) {
    return InputKind::kPoints;
  }
  return kind_of_input(input);
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
void check_points_output(const ConvertOptions& options) {
  const PointOutput& output = options.output;
  const bool piped = output.path == "-" && output.format.empty();
  const PointFormat* format = &own_point_stream();
  try {
    if (!piped) format = &point_format_to_write(output.path, output.format);
  } catch (const InvalidArgument&) {
    if (!is_mesh_output(output)) throw;
    throw Error(
        fmt::format("{}: these are points, and {} would be a mesh: use spillway triangulate",
                    options.inputs.front(), output.name()));
  }
  check_las_version(output, format->has_versions);
  static_cast<void>(format_name_of(output));
}

void run_points(const ConvertOptions& options, FileSystem& files, ScratchFolder& scratch,
                Progress& progress) {
  check_points_output(options);
  progress.begin("convert", "points");
  const auto source =
      make_point_source(files, options.inputs, options.input,
                        {.index = true, .attributes = true, .memory = memory_limit(options.memory)},
                        scratch, progress);
  convert_points(*source, options.output, options.lattice, scratch, progress);
}

/// Throws if the output is of a point format, and of no mesh format.
void check_mesh_output(const ConvertOptions& options) {
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

void run_mesh(const ConvertOptions& options, ProbedInput& input, InputKind kind,
              ScratchFolder& scratch, Progress& progress) {
  if (options.inputs.size() > 1) {
    throw UsageError("several meshes do not become one: convert them one by one");
  }
  std::vector<std::string_view> of_points(kInputOptionNames.begin(), kInputOptionNames.end());
  of_points.insert(of_points.end(), {"--scale", "--offset", "--las-version"});
  refuse_given(*options.app, of_points, fmt::format("on {}, which is a mesh", input.path()));
  check_mesh_output(options);
  convert_mesh(input, kind, {options.mesh_format, options.output.path, options.output.format},
               scratch, progress);
}

/// One number for all axes, or one each.
void check_axes(std::string_view option, const std::vector<double>& values) {
  if (values.size() == 2 || values.size() > 3) {
    throw UsageError(fmt::format("{}: give one number, or three for x, y and z", option));
  }
}

int run(const ConvertOptions& options) {
  check_axes("--scale", options.lattice.scale);
  check_axes("--offset", options.lattice.offset);
  const bool reads_pipe = std::ranges::find(options.inputs, "-") != options.inputs.end();
  Progress progress = make_progress(options.report, reads_pipe);
  const auto scratch = make_scratch_folder(options.memory);
  ProbedInput input(disk(), options.inputs.front());
  const InputKind kind = kind_of(options, input);
  if (kind == InputKind::kPoints) {
    run_points(options, input, *scratch, progress);
  } else {
    run_mesh(options, input, kind, *scratch, progress);
  }
  return kExitDone;
}

}  // namespace

Subcommand add_convert(CommandLine& root) {
  const auto options = std::make_shared<ConvertOptions>();
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
  add_choice(app, "--mesh-format", options->mesh_format, mesh_format_names(),
             "The input is a mesh of this format, which neither content nor name tell");
  add_las_version(app, options->output);
  add_number_list(app, "--scale", options->lattice.scale,
                  "Round coordinates to multiples of this; one number, or one for each axis", true)
      .value_name("N[,N,N]");
  add_number_list(app, "--offset", options->lattice.offset,
                  "Count these multiples from here on; likewise")
      .value_name("N[,N,N]");
  add_input_options(app, options->input);
  add_memory_options(app, options->memory);
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }};
}

}  // namespace spillway::detail

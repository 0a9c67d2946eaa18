#include <fmt/format.h>
#include <spillway/height.h>
#include <spillway/input.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "formats/meshes/mesh_formats.h"
#include "formats/points/create_points.h"
#include "src/runtime/memory_budget.h"
#include "tools/commands/command.h"
#include "tools/commands/run_statistics.h"
#include "tools/commands/skipped_inputs.h"
#include "tools/options/command_options.h"
#include "tools/options/input_options.h"
#include "tools/options/point_output.h"
#include "tools/options/triangulation_options.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway height survey.laz --ground-class 2 -o heights.laz\n"
    "  spillway height 'tiles/*.laz' --ground-class 2,9 -o trees.laz --replace-z --min-height 2\n"
    "  spillway height after.las --ground before.las -o change.csv\n"
    "  spillway height survey.laz --ground dtm.spm -o heights.spp --keep-class 3-5\n"
    "Heights are linear within the triangles of the ground; docs/height.md tells more.";

struct HeightCommandOptions : TriangulationOptions {
  std::vector<std::string> ground;
  std::string ground_class;
  std::string mesh_format;
  PointOutput output;
  std::string attributes;
  bool replace_z = false;
  std::optional<double> min_height;
  std::optional<double> max_height;
  std::string nodata = "-9999";
  bool force = false;
};

double parse_height_nodata(const std::string& text) {
  if (text == "nan" || text == "NaN") return std::numeric_limits<double>::quiet_NaN();
  const auto value = parse_number(text);
  if (!value) throw UsageError(fmt::format("\"{}\" is not a height; give a number or nan", text));
  return *value;
}

HeightOptions height_options(const HeightCommandOptions& options) {
  return {.replace_z = options.replace_z,
          .min_height = options.min_height,
          .max_height = options.max_height,
          .nodata = parse_height_nodata(options.nodata),
          .foreign_crs = options.input.force_crs};
}

void check_output(const HeightCommandOptions& options) {
  const PointOutput& output = options.output;
  const bool piped = output.path == "-" && output.format.empty();
  const PointFormat& format =
      piped ? own_point_stream() : point_format_to_write(output.path, output.format);
  check_las_version(output, format.has_versions);
}

/// An input is replaced by what holds less, or other things, if that is wanted.
void check_overwriting(const HeightCommandOptions& options) {
  if (options.force || options.output.path == "-") return;
  const auto is_output = [&](const std::string& path) {
    std::error_code unknown;
    return std::filesystem::equivalent(path, options.output.path, unknown);
  };
  const bool changes = options.replace_z || options.min_height || options.max_height;
  if (std::ranges::any_of(options.ground, is_output) ||
      (changes && std::ranges::any_of(options.inputs, is_output))) {
    throw UsageError(
        fmt::format("{} is an input, which would be replaced by something else: give "
                    "another name, or --force",
                    options.output.path));
  }
}

/// Whether the ground is a mesh.
bool is_mesh(const HeightCommandOptions& options, const Context& context) {
  if (!options.mesh_format.empty()) return true;
  const std::string& path = options.ground.front();
  if (options.ground.size() > 1 || stands_for_several(path)) return false;
  return (path == "-" || std::filesystem::exists(path)) &&
         kind_of_input(path, context) == InputKind::kMesh;
}

void refuse_options_of_points(const HeightCommandOptions& options) {
  const std::string where = fmt::format("where the ground, {}, is a mesh", options.ground.front());
  refuse_given(*options.app, {"--ground-class"}, where);
  std::vector<std::string_view> names(kTriangulationOptionNames.begin(),
                                      kTriangulationOptionNames.end());
  names.emplace_back("--max-edge");
  refuse_given(*options.app, names, where);
  if (options.ground.size() > 1) throw UsageError("the ground is one mesh, or points");
}

HeightReport measure(const HeightCommandOptions& options, PointSink& sink,
                     const TriangulateOptions& how, const Context& context) {
  const HeightOptions heights = height_options(options);
  PointOptions points = point_options(options.input, 0);
  points.metadata = true;
  const std::vector<int> classes =
      options.ground_class.empty() ? std::vector<int>{} : parse_classes(options.ground_class);
  if (options.ground.empty()) {
    return measure_heights(options.inputs, points, classes, sink, heights, how, context);
  }
  const bool over_mesh = is_mesh(options, context);
  if (over_mesh) refuse_options_of_points(options);
  const auto source = open_points(options.inputs, points, context);
  if (over_mesh) {
    const auto mesh = open_mesh(options.ground.front(),
                                mesh_options(options.input, options.mesh_format), context);
    return measure_heights(*source, *mesh, sink, heights, context);
  }
  PointOptions of_ground;
  of_ground.classes = classes;
  of_ground.crs = points.crs;
  of_ground.foreign_crs = points.foreign_crs;
  of_ground.to_crs = points.to_crs;
  of_ground.z_multiplier = points.z_multiplier;
  of_ground.skip_invalid = points.skip_invalid;
  of_ground.max_expansion = points.max_expansion;
  of_ground.salvage = points.salvage;
  of_ground.skip_broken = points.skip_broken;
  of_ground.keep_withheld = points.keep_withheld;
  const auto ground = open_points(options.ground, of_ground, context);
  return measure_heights(*source, *ground, sink, heights, how, context);
}

void say(const HeightCommandOptions& options, const HeightReport& report, double seconds,
         ProgressLine& progress) {
  const PointConversion& points = report.points;
  if (points.farthest > 0) {
    progress.say(
        fmt::format("coordinates rounded, which moved them by {:.3g} at most", points.farthest));
  }
  if (!points.lost.empty()) {
    progress.say(fmt::format("not kept: {}", fmt::join(points.lost, ", ")));
  }
  if (!points.points.all_kept()) progress.say(describe(points.points));
  if (report.other_heights > 0) {
    progress.say(fmt::format("{} points of other heights left out", report.other_heights));
  }
  if (report.without_ground > 0) {
    progress.insist(fmt::format("warning: {} points lie over no triangle of the ground{}",
                                report.without_ground,
                                options.min_height || options.max_height
                                    ? "; they are left out"
                                    : fmt::format(": their height is {}", options.nodata)));
  }
  progress.say(
      fmt::format("{} points in {}, heights from {:.6g} to {:.6g}, {} below the ground of {} "
                  "triangles, {:.2f} s",
                  points.written, options.output.name(), report.lowest, report.highest,
                  report.below_ground, report.ground.mesh.simplices, seconds));
}

Json height_json(const HeightReport& report) {
  return {{"written", report.points.written},
          {"without_ground", report.without_ground},
          {"below_ground", report.below_ground},
          {"other_heights", report.other_heights},
          {"lowest", report.lowest},
          {"highest", report.highest},
          {"spilled_bytes", report.spilled_bytes}};
}

int run(const HeightCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  if (options.ground.empty() && options.ground_class.empty()) {
    throw UsageError(
        "what is the ground? Give --ground-class for points of these classes, or --ground for "
        "other points or a mesh");
  }
  const auto pipes = [](const std::vector<std::string>& paths) {
    return std::ranges::count(paths, "-");
  };
  if (pipes(options.inputs) + pipes(options.ground) > 1) {
    throw UsageError("standard input is either the points or the ground");
  }
  check_output(options);
  check_overwriting(options);
  if (options.ground.empty()) {
    refuse_given(*options.app, {"--mesh-format"}, "without --ground, of which it tells");
  }
  if (options.min_height || options.max_height) {
    refuse_given(*options.app, {"--nodata"},
                 "with --min-height or --max-height, which leave out points without a height");
  }
  check_statistics_file(options, options.output.path, "the points");
  ProgressLine progress = make_progress(options.report, options.output.path);
  reuse_freed_memory();
  const Context context(context_options(options.memory, thread_count(options), progress));
  const auto file = create_points(options.output.path,
                                  {.format = format_name_of(options.output),
                                   .las_version = options.output.las_version,
                                   .force = options.force,
                                   .attributes = attribute_names(options.attributes)},
                                  context);
  HeightReport report;
  const TracedReport ground =
      trace_run(options, triangulate_options(options, 2), [&](const TriangulateOptions& how) {
        report = measure(options, *file, how, context);
        return report.ground;
      });
  const RunFacts facts = facts_of_run(options, options.output.path, context, start);
  say(options, report, facts.seconds, progress);
  write_statistics(options, ground, facts, {{"heights", height_json(report)}});
  std::vector<SkippedFile> skipped = report.points.skipped_files;
  for (const SkippedFile& file_of_ground : ground.skipped_files) {
    if (std::ranges::none_of(
            skipped, [&](const SkippedFile& one) { return one.path == file_of_ground.path; })) {
      skipped.push_back(file_of_ground);
    }
  }
  return tell_skipped(skipped, progress);
}

}  // namespace

Subcommand add_height(CommandLine& root) {
  const auto options = std::make_shared<HeightCommandOptions>();
  CommandLine& app = root.add_subcommand("height", "Measure how high points are above the ground");
  options->app = &app;
  app.set_footer(kExamples);
  app.add_option("IN", options->inputs, "Point files, as `triangulate` takes them").required();
  app.add_option("-o,--output", options->output.path, "Point file; - is standard output")
      .required()
      .value_name("FILE");
  app.add_option("--ground", options->ground,
                 "The ground: point files, or one mesh of triangles; default: points of IN")
      .value_name("FILE");
  take_parsed(app.add_option("--ground-class", options->ground_class,
                             "Points of these classes are the ground, as 2 or 2,9")
                  .value_name("LIST"),
              [](const std::string& text) { parse_classes(text); });
  app.add_flag("--replace-z", options->replace_z,
               "Write heights in place of z, not as the attribute HeightAboveGround");
  take_number(app.add_option("--min-height", options->min_height, "Write points so high or higher"))
      .value_name("H");
  take_number(app.add_option("--max-height", options->max_height, "Write points so high or lower"))
      .value_name("H");
  take_parsed(app.add_option("--nodata", options->nodata,
                             "Height of points over no triangle: a number or nan")
                  .value_name("V")
                  .show_default(),
              [](const std::string& text) { parse_height_nodata(text); });
  add_choice(app, "--output-format", options->output.format, written_point_format_names(),
             "Format of the output, where the name does not tell");
  add_las_version(app, options->output);
  add_attributes(app, options->attributes, "Attributes to write besides [all; none of text]");
  app.add_flag("--force", options->force, "Replace an input, though the output holds less than it");
  add_choice(app, "--mesh-format", options->mesh_format, mesh_format_names(),
             "Format of a ground that is a mesh, where neither content nor name tell");
  add_triangulation_options(app, *options);
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }};
}

}  // namespace spillway::command

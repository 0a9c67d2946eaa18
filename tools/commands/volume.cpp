#include <fmt/format.h>
#include <spillway/volume.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/commands/command.h"
#include "tools/commands/run_statistics.h"
#include "tools/commands/skipped_inputs.h"
#include "tools/commands/terrain_input.h"
#include "tools/report/json_text.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway volume before.laz after.laz\n"
    "  spillway volume ground.spm design.xyz --json\n"
    "  spillway volume heap.las --level 102.5\n"
    "  spillway volume '2024/*.laz' '2025/*.laz' --keep-class 2 --max-edge 20\n"
    "Cut is where the first surface lies above the second, or above the level; docs/volume.md "
    "tells more.";

struct VolumeCommandOptions : TerrainOptions {
  std::optional<double> level;
  std::optional<double> z_factor;
  bool json = false;
};

/// What the runs of both surfaces, or of the one, were like.
struct Measured {
  Volume volume;
  std::vector<TracedReport> surfaces;
};

VolumeOptions volume_options(const VolumeCommandOptions& options) {
  return {.max_edge = max_edge(options),
          .z_factor = options.z_factor,
          .foreign_crs = options.input.force_crs};
}

/// The options of the run of one surface.
VolumeCommandOptions of_surface(const VolumeCommandOptions& options, const std::string& input) {
  VolumeCommandOptions one = options;
  one.inputs = {input};
  return one;
}

Measured measure(const VolumeCommandOptions& options, const Context& context,
                 ProgressLine& progress) {
  Measured measured;
  const auto send = [&](const std::string& input, MeshSink& sink) {
    measured.surfaces.push_back(send_terrain(of_surface(options, input), sink, context));
    say_what_is_left_out(options, measured.surfaces.back(), progress);
  };
  if (options.level) {
    const auto sink = measure_above(*options.level, volume_options(options), context);
    send(options.inputs[0], *sink);
    measured.volume = sink->volume();
    return measured;
  }
  const auto between = measure_between(volume_options(options), context);
  send(options.inputs[0], between->first());
  send(options.inputs[1], between->second());
  measured.volume = between->measure();
  return measured;
}

Json volume_json(const Volume& volume) {
  return {{"cut", volume.cut},
          {"fill", volume.fill},
          {"net", volume.net()},
          {"cut_area", volume.cut_area},
          {"fill_area", volume.fill_area},
          {"area", volume.area},
          {"first_area", volume.first_area},
          {"second_area", volume.second_area},
          {"spilled_bytes", volume.spilled_bytes}};
}

std::string volume_text(const VolumeCommandOptions& options, const Volume& volume) {
  const std::string above =
      options.level ? fmt::format("the level {}", *options.level) : "the second surface";
  std::string text;
  const auto add = [&](const char* name, double value, const std::string& what) {
    text += fmt::format("{:<12} {:>18.3f}  {}\n", name, value, what);
  };
  add("cut", volume.cut, "volume above " + above);
  add("fill", volume.fill, "volume below " + above);
  add("net", volume.net(), "cut less fill");
  add("cut_area", volume.cut_area, "area above");
  add("fill_area", volume.fill_area, "area below");
  add("area", volume.area, options.level ? "area of the surface" : "area that both cover");
  if (!options.level) {
    add("first_area", volume.first_area, "area of the first surface");
    add("second_area", volume.second_area, "area of the second surface");
  }
  return text;
}

void warn_of_uncovered(const VolumeCommandOptions& options, const Volume& volume,
                       ProgressLine& progress) {
  if (options.level) return;
  if (volume.area == 0) {
    progress.insist("warning: the surfaces have no area in common");
    return;
  }
  constexpr double kShare = 0.001;  // of a surface
  const double uncovered =
      std::max(1 - volume.area / volume.first_area, 1 - volume.area / volume.second_area);
  if (uncovered > kShare) {
    progress.say(fmt::format("up to {:.1f}% of a surface has nothing of the other above or below",
                             100 * uncovered));
  }
}

void check(const VolumeCommandOptions& options) {
  if (options.inputs.size() > 2) {
    throw UsageError(
        "a volume lies between two surfaces: give a folder, 'pattern' or @list for one of many "
        "files");
  }
  if (options.level && options.inputs.size() == 2) {
    throw UsageError("--level stands for the second surface: leave one of them out");
  }
  if (!options.level && options.inputs.size() == 1) {
    throw UsageError("what does the surface lie above? Give a second one, or --level");
  }
  if (options.level) return;
  if (std::ranges::count(options.inputs, "-") == 2) {
    throw UsageError("standard input is one surface, not both");
  }
  refuse_given(*options.app, {"--tasks", "--resume", "--checkpoint-every"},
               "with two surfaces, which are two runs");
}

int run(const VolumeCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check(options);
  check_statistics_file(options, "-", "the volumes");
  ProgressLine progress = make_progress(options.report);
  const Context context = terrain_context(options, progress);
  const Measured measured = measure(options, context, progress);
  warn_of_uncovered(options, measured.volume, progress);
  Json json = {{"volume", volume_json(measured.volume)}};
  write_text("-", options.json ? json_text(json["volume"], 2) + "\n"
                               : volume_text(options, measured.volume));
  const RunFacts facts = facts_of_run(options, "", context, start);
  if (measured.surfaces.size() > 1) json["second"] = to_json(measured.surfaces[1], facts);
  write_statistics(options, measured.surfaces[0], facts, json);
  int code = kExitDone;
  for (const TracedReport& surface : measured.surfaces) {
    code = std::max(code, tell_skipped(surface.skipped_files, progress));
  }
  return code;
}

}  // namespace

Subcommand add_volume(CommandLine& root) {
  const auto options = std::make_shared<VolumeCommandOptions>();
  CommandLine& app = root.add_subcommand("volume", "Measure cut and fill between two surfaces");
  options->app = &app;
  app.set_footer(kExamples);
  take_number(app.add_option("--level", options->level,
                             "Measure above and below this height, not a second surface"))
      .value_name("H");
  take_positive_number(app.add_option("--z-factor", options->z_factor,
                                      "Multiply heights by this [as the coordinate system tells]"))
      .value_name("F");
  app.add_flag("--json", options->json, "Print JSON");
  add_terrain_options(app, *options);
  options->uses_crs = true;
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }};
}

}  // namespace spillway::command

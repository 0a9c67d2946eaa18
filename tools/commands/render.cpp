#include <fmt/format.h>
#include <spillway/picture.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/geometry/simplex_name.h"
#include "tools/commands/command.h"
#include "tools/commands/run_statistics.h"
#include "tools/commands/skipped_inputs.h"
#include "tools/commands/terrain_input.h"
#include "tools/options/command_options.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway render survey.laz -o view.png\n"
    "  spillway render survey.laz -o edges.png --zoom 636200,849100,636260,849150 --wireframe\n"
    "  spillway render tin.spm -o view.png --size 4000 --exaggerate 2\n"
    "  spillway render cloud.npy --dim 3 -o hull.png --view 120,30 --wireframe\n"
    "  spillway render tetrahedra.vtu -o slice.png --slice z=0.5\n"
    "A terrain becomes a shaded relief, tetrahedra their hull or a slice; docs/render.md tells "
    "more.";

struct RenderCommandOptions : TerrainOptions {
  std::string output;
  std::uint32_t size = 1200;
  std::vector<double> zoom;
  bool wireframe = false;
  double exaggeration = 0;
  std::vector<double> view;
  std::string slice;
  bool transparent = false;
};

Slice parse_slice(const std::string& text) {
  const std::string axes = "xyz";
  const std::size_t axis = text.empty() ? std::string::npos : axes.find(text[0]);
  const auto value =
      text.size() < 3 || text[1] != '=' ? std::nullopt : parse_number(text.substr(2));
  if (axis == std::string::npos || !value) {
    throw UsageError(fmt::format("\"{}\" is not a plane; give x=VALUE, y=VALUE or z=VALUE", text));
  }
  return {static_cast<int>(axis), *value};
}

Extent parse_zoom(const std::vector<double>& numbers) {
  if (numbers.size() != 4 || numbers[0] >= numbers[2] || numbers[1] >= numbers[3]) {
    throw UsageError("--zoom takes a box of some area: xmin,ymin,xmax,ymax");
  }
  return {{numbers[0], numbers[1], 0}, {numbers[2], numbers[3], 0}};
}

PictureOptions picture_options(const RenderCommandOptions& options) {
  PictureOptions picture;
  picture.size = options.size;
  picture.wireframe = options.wireframe;
  picture.transparent = options.transparent;
  picture.max_edge = max_edge(options);
  if (!options.zoom.empty()) picture.zoom = parse_zoom(options.zoom);
  if (options.exaggeration != 0) picture.exaggeration = options.exaggeration;
  if (!options.slice.empty()) picture.slice = parse_slice(options.slice);
  if (!options.view.empty()) {
    if (options.view.size() != 2 || std::abs(options.view[1]) > 90) {
      throw UsageError("--view takes an azimuth and an elevation from -90 to 90 degrees, as 30,25");
    }
    picture.view = {options.view[0], options.view[1]};
  }
  return picture;
}

void check_outputs(const RenderCommandOptions& options) {
  if (options.output == "-" && ::isatty(STDOUT_FILENO) != 0) {
    throw UsageError("a picture cannot go to a terminal: name a file, or pipe it on");
  }
  check_duplicates(options, options.dimension);
  check_statistics_file(options, options.output, "the picture");
}

void say(const RenderCommandOptions& options, const Report& report, const PictureReport& picture,
         const RunFacts& facts, ProgressLine& progress) {
  say_what_is_left_out(options, report, progress);
  if (picture.edges_too_small) {
    progress.say(fmt::format("most triangles are too small for their edges to be seen: {}",
                             report.dimension == 2 ? "zoom in with --zoom, or give a larger --size"
                                                   : "give a larger --size"));
  }
  progress.say(fmt::format("{} vertices, {} {}; {} x {} pixels, {}, {:.2f} s", report.mesh.vertices,
                           report.mesh.simplices, simplices_of(report.dimension), picture.columns,
                           picture.rows, picture.description, facts.seconds));
}

int run(const RenderCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const PictureOptions how = picture_options(options);
  check_outputs(options);
  ProgressLine progress =
      make_progress(options.report, std::ranges::count(options.inputs, "-") > 0);
  const Context context = terrain_context(options, progress);
  const auto picture = create_picture(options.output, how, context);
  const TracedReport report = send_terrain(options, *picture, context);
  const RunFacts facts = facts_of_run(options, options.output, context, start);
  say(options, report, picture->report(), facts, progress);
  const Json size = {{"columns", picture->report().columns}, {"rows", picture->report().rows}};
  write_statistics(options, report, facts, {{"picture", size}});
  return tell_skipped(report.skipped_files, progress);
}

}  // namespace

Subcommand add_render(CommandLine& root) {
  const auto options = std::make_shared<RenderCommandOptions>();
  CommandLine& app = root.add_subcommand("render", "Draw a picture: a relief, a hull or a slice");
  app.set_footer(kExamples);
  app.add_option("-o,--output", options->output, "PNG file; - is standard output")
      .required()
      .value_name("FILE");
  add_dimension(app, options->dimension, "How points are triangulated: a terrain, or tetrahedra");
  const std::string group = "Picture";
  take_whole_number(app.add_option("--size", options->size, "Pixels of the longer side"),
                    kLeastPictureSize, kMostPictureSize)
      .value_name("N")
      .show_default()
      .group(group);
  add_number_list(app, "--zoom", options->zoom, "Show xmin,ymin,xmax,ymax only [everything]")
      .value_name("BOX")
      .group(group);
  app.add_flag("--wireframe", options->wireframe, "Draw the edges of triangles").group(group);
  take_positive_number(
      app.add_option("--exaggerate", options->exaggeration,
                     "Shade a terrain as if it were Z times as high [chosen so that slopes show]"))
      .value_name("Z")
      .group(group);
  add_number_list(app, "--view", options->view,
                  "Look at tetrahedra from AZIMUTH,ELEVATION in degrees [30,25]")
      .value_name("A,E")
      .group(group);
  take_parsed(app.add_option("--slice", options->slice,
                             "Cut tetrahedra by a plane: x=VALUE, y=... or z=..."),
              parse_slice)
      .value_name("PLANE")
      .group(group);
  app.add_flag("--transparent", options->transparent, "Leave the background transparent, not white")
      .group(group);
  add_terrain_options(app, *options);
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }};
}

}  // namespace spillway::command

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

#include "formats/rasters/world_file.h"
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
    "  spillway render survey.laz -o classes.png --color class --legend --scale-bar\n"
    "  spillway render survey.laz -o aslant.png --view 200,35 --shadows --light 300,30\n"
    "  spillway render survey.laz -o view.html --triangles 1000000\n"
    "  spillway render cloud.npy --dim 3 -o hull.png --view 120,30 --wireframe\n"
    "  spillway render tetrahedra.vtu -o slice.png --slice z=0.5\n"
    "A terrain becomes a shaded relief, or a page that turns it in a browser; tetrahedra become "
    "their hull or a slice. docs/render.md tells more.";

/// In the order of PictureColour.
const std::vector<std::string>& color_names() {
  static const std::vector<std::string> names = {"height", "class", "intensity", "return", "rgb"};
  return names;
}

struct RenderCommandOptions : TerrainOptions {
  std::string output;
  std::uint32_t size = 0;       ///< 0: not given
  std::uint64_t triangles = 0;  ///< likewise
  std::string color = color_names().front();
  std::string ramp;
  std::vector<double> zoom;
  bool wireframe = false;
  double exaggeration = 0;
  std::vector<double> view;
  std::vector<double> light;
  bool shadows = false;
  std::string slice;
  bool transparent = false;
  bool legend = false;
  bool scale_bar = false;
  bool world_file = false;
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
  if (options.size != 0) picture.size = options.size;
  if (options.triangles != 0) picture.triangles = options.triangles;
  const auto color = std::ranges::find(color_names(), options.color) - color_names().begin();
  picture.colour = static_cast<PictureColour>(color);
  picture.ramp = options.ramp;
  picture.shadows = options.shadows;
  picture.legend = options.legend;
  picture.scale_bar = options.scale_bar;
  picture.world_file = options.world_file;
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
  if (!options.light.empty()) {
    if (options.light.size() != 2 || options.light[1] < 0 || options.light[1] > 90) {
      throw UsageError("--light takes an azimuth and an altitude from 0 to 90 degrees, as 315,45");
    }
    picture.light = {options.light[0], options.light[1]};
  }
  return picture;
}

void check_outputs(const RenderCommandOptions& options) {
  if (options.output == "-" && ::isatty(STDOUT_FILENO) != 0) {
    throw UsageError("a picture cannot go to a terminal: name a file, or pipe it on");
  }
  check_duplicates(options, options.dimension);
  check_statistics_file(options, options.output, "the picture");
  if (options.world_file) {
    check_statistics_file(options, formats::world_file_path(options.output), "the world file");
  }
}

void say(const RenderCommandOptions& options, const Report& report, const PictureReport& picture,
         const RunFacts& facts, ProgressLine& progress) {
  say_what_is_left_out(options, report, progress);
  if (picture.edges_too_small) {
    progress.say(fmt::format("most triangles are too small for their edges to be seen: {}",
                             report.dimension == 2 ? "zoom in with --zoom, or give a larger --size"
                                                   : "give a larger --size"));
  }
  const std::string pixels =
      picture.triangles > 0 ? "" : fmt::format("{} x {} pixels, ", picture.columns, picture.rows);
  progress.say(fmt::format("{} vertices, {} {}; {}{}, {:.2f} s", report.mesh.vertices,
                           report.mesh.simplices, simplices_of(report.dimension), pixels,
                           picture.description, facts.seconds));
}

int run(const RenderCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const PictureOptions how = picture_options(options);
  check_outputs(options);
  ProgressLine progress = make_progress(options.report, options.output);
  const Context context = terrain_context(options, progress);
  const auto picture = create_picture(options.output, how, context);
  const TracedReport report = send_terrain(options, *picture, context);
  const RunFacts facts = facts_of_run(options, options.output, context, start);
  say(options, report, picture->report(), facts, progress);
  const PictureReport& seen = picture->report();
  Json size = {{"columns", seen.columns}, {"rows", seen.rows}};
  if (seen.triangles > 0) size["triangles"] = seen.triangles;
  write_statistics(options, report, facts, {{"picture", size}});
  return tell_skipped(report.skipped_files, progress);
}

}  // namespace

Subcommand add_render(CommandLine& root) {
  const auto options = std::make_shared<RenderCommandOptions>();
  CommandLine& app =
      root.add_subcommand("render", "Draw a picture: a relief, a page, a hull or a slice");
  app.set_footer(kExamples);
  app.add_option("-o,--output", options->output,
                 "FILE.png, GeoTIFF FILE.tif or page FILE.html; - is standard output, of a PNG")
      .required()
      .value_name("FILE");
  add_dimension(app, options->dimension, "How points are triangulated: a terrain, or tetrahedra");
  const std::string group = "Picture";
  take_whole_number(
      app.add_option("--size", options->size,
                     fmt::format("Pixels of a PNG's longer side [{}]", kUsualPictureSize)),
      kLeastPictureSize, kMostPictureSize)
      .value_name("N")
      .group(group);
  take_whole_number(
      app.add_option("--triangles", options->triangles,
                     fmt::format("Triangles of a page at most [{}]", kUsualPageTriangles)),
      kLeastPageTriangles, kMostPageTriangles)
      .value_name("N")
      .group(group);
  add_number_list(app, "--zoom", options->zoom, "Show xmin,ymin,xmax,ymax only [everything]")
      .value_name("BOX")
      .group(group);
  add_choice(app, "--color", options->color, color_names(), "What colours of a terrain stand for")
      .show_default()
      .group(group);
  add_choice(app, "--ramp", options->ramp, ramp_names(),
             "Colours of heights or intensities [relief, grey]")
      .group(group);
  app.add_flag("--wireframe", options->wireframe, "Draw the edges of triangles").group(group);
  take_positive_number(
      app.add_option("--exaggerate", options->exaggeration,
                     "Show a terrain as if it were Z times as high [chosen so that slopes show]"))
      .value_name("Z")
      .group(group);
  add_number_list(app, "--view", options->view,
                  "Look from AZIMUTH,ELEVATION in degrees [a terrain from above]")
      .value_name("A,E")
      .group(group);
  add_number_list(app, "--light", options->light,
                  "Light a terrain from AZIMUTH,ALTITUDE in degrees [315,45]")
      .value_name("A,E")
      .group(group);
  app.add_flag("--shadows", options->shadows, "Let a terrain cast shadows").group(group);
  take_parsed(app.add_option("--slice", options->slice,
                             "Cut tetrahedra by a plane: x=VALUE, y=... or z=..."),
              parse_slice)
      .value_name("PLANE")
      .group(group);
  app.add_flag("--legend", options->legend, "Tell below a PNG of a terrain what colours stand for")
      .group(group);
  app.add_flag("--scale-bar", options->scale_bar, "Draw below it how long a bar is").group(group);
  app.add_flag("--world-file", options->world_file,
               "Write a world file beside it: FILE.pgw for FILE.png")
      .group(group);
  app.add_flag("--transparent", options->transparent, "Leave the background transparent, not white")
      .group(group);
  add_terrain_options(app, *options);
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }};
}

}  // namespace spillway::command

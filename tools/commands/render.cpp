#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/rasters/png.h"
#include "formats/rasters/raster_formats.h"
#include "src/parallel/parallel.h"
#include "stream/plan/memory_plan.h"
#include "tools/commands/command.h"
#include "tools/commands/output_check.h"
#include "tools/commands/render_scene.h"
#include "tools/report/json_text.h"
#include "tools/report/statistics.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"

namespace spillway::detail {
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

constexpr std::uint64_t kLeastMemory = std::uint64_t{64} << 20;
/// The part of --memory that is for pixels while triangles come.
constexpr std::uint64_t kPixelShare = 4;
/// What a pixel takes while the picture is drawn, when the mesh has gone through; and the part of
/// --memory that is there for it.
constexpr std::uint64_t kBytesOfAPixel = 16;
constexpr std::uint64_t kPictureShare = 2;
/// Pixels of a picture's longer side: what leaves room for the margin, and what PNG can be made of.
constexpr std::uint32_t kLeastSize = 32;
constexpr std::uint32_t kMostSize = 20'000;

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

AxisPlane parse_slice(const std::string& text) {
  const std::string axes = "xyz";
  const std::size_t axis = text.empty() ? std::string::npos : axes.find(text[0]);
  const auto value =
      text.size() < 3 || text[1] != '=' ? std::nullopt : parse_number(text.substr(2));
  if (axis == std::string::npos || !value) {
    throw UsageError(fmt::format("\"{}\" is no plane; give x=VALUE, y=VALUE or z=VALUE", text));
  }
  return {static_cast<int>(axis), *value};
}

Box<2> parse_zoom(const std::vector<double>& numbers) {
  if (numbers.size() != 4 || numbers[0] >= numbers[2] || numbers[1] >= numbers[3]) {
    throw UsageError("--zoom takes a box of some area: xmin,ymin,xmax,ymax");
  }
  return {{numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
}

RenderRequest parse_request(const RenderCommandOptions& options) {
  RenderRequest request;
  request.size = options.size;
  request.wireframe = options.wireframe;
  if (!options.zoom.empty()) request.zoom = parse_zoom(options.zoom);
  if (options.exaggeration != 0) request.exaggeration = options.exaggeration;
  if (!options.slice.empty()) request.slice = parse_slice(options.slice);
  if (!options.view.empty()) {
    if (options.view.size() != 2 || std::abs(options.view[1]) > 90) {
      throw UsageError("--view takes an azimuth and an elevation from -90 to 90 degrees, as 30,25");
    }
    request.view = {options.view[0], options.view[1]};
  }
  return request;
}

/// Makes a scene of whatever comes.
class RenderUse : public TerrainUse {
 public:
  RenderUse(const RenderRequest& request, std::uint64_t memory, unsigned threads,
            ScratchFolder& scratch)
      : request_(request), memory_(memory), threads_(threads), scratch_(scratch) {}

  BlockSink& begin(const TerrainHeader& header) override {
    scene_ = header.dimension == 2
                 ? make_relief_scene(request_, header, memory_, threads_, scratch_)
                 : make_space_scene(request_, header);
    return scene_->writer();
  }

  [[nodiscard]] bool wants_extent() const override { return !request_.zoom; }
  void extent_known(const Box<2>& extent, std::uint64_t /*vertices*/) override {
    scene_->extent_known(extent);
  }

  [[nodiscard]] Scene& scene() { return *scene_; }

 private:
  const RenderRequest& request_;
  const std::uint64_t memory_;
  const unsigned threads_;
  ScratchFolder& scratch_;
  std::unique_ptr<Scene> scene_;
};

void check_outputs(const RenderCommandOptions& options) {
  if (options.output == "-") {
    if (::isatty(STDOUT_FILENO) != 0) {
      throw UsageError("a picture is nothing for a terminal: name a file, or pipe it on");
    }
  } else if (!kPng.is_named(options.output)) {
    throw UsageError(fmt::format("-o {}: pictures are written as .{} only", options.output,
                                 kPng.extensions.front()));
  }
  if (options.output == options.stats_path) {
    throw UsageError("the picture and --stats cannot go to the same place: " + options.output);
  }
  check_duplicates(options, options.dimension);
  check_can_create(disk(), options.output);
  if (!options.stats_path.empty()) check_can_create(disk(), options.stats_path);
}

std::uint64_t checked_memory(const RenderCommandOptions& options) {
  const std::uint64_t limit = memory_limit(options.memory);
  if (limit < kLeastMemory) {
    throw UsageError("--memory is too small: 64 MiB are the least that will do for a picture");
  }
  const std::uint64_t needed = std::uint64_t{options.size} * options.size * kBytesOfAPixel;
  if (needed > limit / kPictureShare) {
    throw UsageError(fmt::format(
        "--size {}: a picture of that size may need {}; give that much twice as --memory, or a "
        "smaller --size",
        options.size, memory_size_text(needed)));
  }
  return limit;
}

int run(const RenderCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const RenderRequest request = parse_request(options);
  check_outputs(options);
  const std::uint64_t limit = checked_memory(options);
  reuse_freed_memory();
  const auto& inputs = options.inputs;
  Progress progress =
      make_progress(options.report, std::count(inputs.begin(), inputs.end(), "-") > 0);
  MemoryBudget budget(limit - limit / kPixelShare, limit);
  const auto scratch = make_scratch_folder(options.memory);
  const unsigned threads = plan_memory(budget.limit(), 2, thread_count(options)).threads;
  RenderUse use(request, limit / kPixelShare, threads, *scratch);
  RunStatistics statistics;
  statistics.output = options.output;
  statistics.output_format = kPng.name;
  statistics.memory_limit = limit;
  feed_terrain(options, use,
               {.budget = budget, .scratch = *scratch, .progress = progress, .threads = threads},
               statistics);
  progress.begin("draw", "pixels");
  std::optional<Picture> picture;
  with_threads(threads, [&] { picture = use.scene().draw(); });
  if (!options.transparent) picture->put_onto(kWhite);
  statistics.output_bytes = write_png(disk(), options.output, picture->columns(), picture->rows(),
                                      picture->bytes(), options.transparent);
  statistics.write_seconds = progress.end(std::uint64_t{picture->columns()} * picture->rows());
  statistics.stream.left_out += use.scene().left_out();
  statistics.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const StreamFigures& stream = statistics.stream;
  const char* const simplices = statistics.dimension == 2 ? "triangles" : "tetrahedra";
  if (stream.left_out > 0) {
    progress.say(fmt::format("{} {} with an edge longer than {} left out", stream.left_out,
                             simplices, *statistics.max_edge));
  }
  for (const std::string& note : use.scene().notes()) progress.say(note);
  progress.say(fmt::format("{} vertices, {} {}; {} x {} pixels, {}, {:.2f} s",
                           stream.totals.vertices, stream.totals.simplices, simplices,
                           picture->columns(), picture->rows(), use.scene().description(),
                           statistics.seconds));
  if (options.stats_path.empty()) return kExitDone;
  Json json = to_json(statistics);
  json["picture"] = {{"columns", picture->columns()}, {"rows", picture->rows()}};
  write_text(options.stats_path, json_text(json, 2) + "\n");
  return kExitDone;
}

}  // namespace

Subcommand add_render(CommandLine& root) {
  const auto options = std::make_shared<RenderCommandOptions>();
  options->tetrahedra = true;
  CommandLine& app = root.add_subcommand("render", "Draw a picture: a relief, a hull or a slice");
  app.set_footer(kExamples);
  app.add_option("-o,--output", options->output, "PNG file; - is standard output")
      .required()
      .value_name("FILE");
  add_dimension(app, options->dimension, "How points are triangulated: a terrain, or tetrahedra");
  const std::string group = "Picture";
  take_whole_number(app.add_option("--size", options->size, "Pixels of the longer side"),
                    kLeastSize, kMostSize)
      .value_name("N")
      .show_default()
      .group(group);
  add_number_list(app, "--zoom", options->zoom, "Show xmin,ymin,xmax,ymax only [everything]")
      .value_name("BOX")
      .group(group);
  app.add_flag("--wireframe", options->wireframe, "Draw the edges of triangles").group(group);
  take_positive_number(
      app.add_option("--exaggerate", options->exaggeration,
                     "Shade a terrain as if it were Z times as high [such that slopes are seen]"))
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

}  // namespace spillway::detail

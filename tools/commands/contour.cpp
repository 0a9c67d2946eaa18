#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/disk/extension.h"
#include "formats/vectors/vector_file.h"
#include "formats/vectors/vector_formats.h"
#include "stream/sinks/contour_writer.h"
#include "tools/commands/command.h"
#include "tools/commands/output_check.h"
#include "tools/commands/terrain_input.h"
#include "tools/options/command_options.h"
#include "tools/report/json_text.h"
#include "tools/report/statistics.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"

namespace spillway::detail {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway contour survey.laz -o contours.gpkg --interval 1\n"
    "  spillway contour 'tiles/*.laz' -o contours.shp --interval 5 --keep-class 2 --thin 1\n"
    "  spillway contour tin.spm -o shore.geojson --levels 0,0.5\n"
    "Lines run with higher ground to their left; docs/contour.md tells more.";

/// The part of --memory that is for points of lines that are not complete.
constexpr std::uint64_t kLineShare = 4;

struct ContourCommandOptions : TerrainOptions {
  std::string output;
  std::optional<double> interval;
  double base = 0;
  std::vector<double> levels;
};

/// The format of the output, by its name.
const VectorFormat& format_of(const std::string& path) {
  if (const VectorFormat* const format = vector_format_of_path(path)) return *format;
  throw UsageError(
      fmt::format("-o {}: contours go to a file that ends in {}", path, vector_extensions(true)));
}

Levels levels_of(const ContourCommandOptions& options) {
  if (!options.levels.empty()) {
    refuse_given(*options.app, {"--interval", "--base"}, "with --levels, which names all heights");
    return Levels::of_list(options.levels);
  }
  if (!options.interval) {
    throw UsageError("--interval, the height between two contours, is missing (or --levels)");
  }
  return Levels::every(*options.interval, options.base);
}

/// Draws contours into a vector file.
class ContourUse : public TerrainUse {
 public:
  ContourUse(const ContourCommandOptions& options, std::uint64_t memory, ScratchFolder& scratch)
      : options_(options), levels_(levels_of(options)), memory_(memory), scratch_(scratch) {}

  BlockSink& begin(const TerrainHeader& header) override {
    VectorLayerOptions layer;
    layer.path = options_.output;
    layer.lines = true;
    layer.crs = header.crs;
    file_.emplace(format_of(options_.output), std::move(layer));
    writer_.emplace(
        ContourOptions{.levels = levels_,
                       .lattice = header.lattice,
                       .max_edge = header.max_edge,
                       .memory = memory_},
        [this](std::span<const Point<2>> points, double height) { add(points, height); }, scratch_);
    return *writer_;
  }

  [[nodiscard]] bool wants_extent() const override { return false; }
  [[nodiscard]] bool needs_heights() const override { return true; }
  void extent_known(const Box<2>& /*extent*/, std::uint64_t /*vertices*/) override {}

  [[nodiscard]] const ContourWriter& writer() const { return *writer_; }
  [[nodiscard]] std::uint64_t points() const { return points_; }

  /// Completes the file; returns its bytes.
  std::uint64_t finish() {
    file_->finish();
    return file_->bytes();
  }

 private:
  void add(std::span<const Point<2>> points, double height) {
    line_.clear();
    for (const Point<2>& point : points) line_.push_back({point[0], point[1], height});
    file_->layer().add_line(line_, height);
    points_ += points.size();
  }

  const ContourCommandOptions& options_;
  Levels levels_;
  std::uint64_t memory_;
  ScratchFolder& scratch_;
  std::optional<VectorFile> file_;
  std::optional<ContourWriter> writer_;
  std::vector<Point<3>> line_;
  std::uint64_t points_ = 0;
};

int run(const ContourCommandOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  format_of(options.output);
  check_can_create(disk(), options.output);
  if (!options.stats_path.empty()) check_can_create(disk(), options.stats_path);
  reuse_freed_memory();
  const auto& inputs = options.inputs;
  Progress progress =
      make_progress(options.report, std::count(inputs.begin(), inputs.end(), "-") > 0);
  const std::uint64_t limit = memory_limit(options.memory);
  MemoryBudget budget(limit - limit / kLineShare, limit);
  const auto scratch = make_scratch_folder(options.memory);
  ContourUse use(options, limit / kLineShare, *scratch);
  RunStatistics statistics;
  statistics.output = options.output;
  statistics.output_format = extension_of(options.output);
  statistics.memory_limit = limit;
  feed_terrain(options, use,
               {.budget = budget,
                .scratch = *scratch,
                .progress = progress,
                .threads = thread_count(options)},
               statistics);
  progress.begin("write", "lines");
  statistics.output_bytes = use.finish();
  statistics.write_seconds = progress.end(use.writer().lines());
  statistics.stream.left_out += use.writer().left_out();
  statistics.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (statistics.stream.left_out > 0) {
    progress.say(fmt::format("{} triangles with an edge longer than {} left out",
                             statistics.stream.left_out, *statistics.max_edge));
  }
  if (use.writer().lines() == 0) {
    progress.insist(
        fmt::format("warning: no lines: no level lies within the heights, which are {} to {}",
                    use.writer().lowest(), use.writer().highest()));
  }
  progress.say(fmt::format("{} vertices, {} triangles; {} lines of {} points, {:.2f} s",
                           statistics.stream.totals.vertices, statistics.stream.totals.simplices,
                           use.writer().lines(), use.points(), statistics.seconds));
  if (options.stats_path.empty()) return kExitDone;
  Json json = to_json(statistics);
  json["contours"] = {{"lines", use.writer().lines()},
                      {"points", use.points()},
                      {"spilled_bytes", use.writer().spilled_bytes()}};
  write_text(options.stats_path, json_text(json, 2) + "\n");
  return kExitDone;
}

}  // namespace

Subcommand add_contour(CommandLine& root) {
  const auto options = std::make_shared<ContourCommandOptions>();
  CommandLine& app = root.add_subcommand("contour", "Draw lines of equal height");
  app.set_footer(kExamples);
  app.add_option("-o,--output", options->output, "Vector file: " + vector_extensions(false))
      .required()
      .value_name("FILE");
  take_positive_number(app.add_option("--interval", options->interval, "Height between two lines"))
      .value_name("H");
  take_number(app.add_option("--base", options->base, "A height that intervals are counted from"))
      .value_name("H")
      .show_default();
  add_number_list(app, "--levels", options->levels, "Heights of lines, instead of an interval")
      .value_name("H,...");
  add_terrain_options(app, *options);
  add_report_options(app, options->report);
  return {&app, [options] { return run(*options); }};
}

}  // namespace spillway::detail

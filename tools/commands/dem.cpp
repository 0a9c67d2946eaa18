#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "formats/gdal/gdal.h"
#include "formats/rasters/raster_file.h"
#include "formats/rasters/raster_formats.h"
#include "src/parallel/parallel.h"
#include "src/terrain/grid_choice.h"
#include "stream/plan/memory_plan.h"
#include "stream/ranks/raster_merge.h"
#include "stream/sinks/dem_writer.h"
#include "tools/commands/command.h"
#include "tools/commands/dem_options.h"
#include "tools/commands/output_check.h"
#include "tools/commands/terrain_input.h"
#include "tools/process/rank_job.h"
#include "tools/report/json_text.h"
#include "tools/report/statistics.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"

namespace spillway::detail {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway dem survey.laz -o dem.tif --resolution 0.5\n"
    "  spillway dem 'tiles/*.laz' -o dtm.tif --resolution 0.5 --keep-class 2 --align --cog\n"
    "  spillway dem survey.las -o relief.tif --resolution 1 --product height,slope,hillshade\n"
    "  spillway dem after.las -o after.tif --like before.tif\n"
    "  spillway triangulate survey.las -o - | spillway dem - -o dem.tif --resolution 1\n"
    "The DEM is interpolated linearly within the triangles; docs/dem.md tells more.";

constexpr std::uint64_t kLeastMemory = std::uint64_t{64} << 20;
/// The part of --memory that is for pixels.
constexpr std::uint64_t kPixelShare = 4;

/// One run of `dem`, and what its stages share.
class Run : public TerrainUse {
 public:
  explicit Run(const DemCommandOptions& options)
      : options_(options),
        dem_options_(dem_options(options, like_)),
        limit_(memory_limit(options.memory)),
        budget_(limit_ - limit_ / kPixelShare, limit_),
        scratch_(make_scratch_folder(options.memory)),
        progress_(make_progress(
            options.report, std::count(options.inputs.begin(), options.inputs.end(), "-") > 0)) {
    if (limit_ < kLeastMemory) {
      throw UsageError("--memory is too small: 64 MiB are the least that will do for a DEM");
    }
    dem_options_.memory = limit_ / kPixelShare;
    dem_options_.threads = plan_memory(budget_.limit(), 2, thread_count(options)).threads;
    statistics_.output = options.output;
    statistics_.output_format = kGeoTiff.name;
    statistics_.memory_limit = limit_;
  }

  int run() {
    reuse_freed_memory();
    feed_terrain(options_, *this,
                 {.budget = budget_,
                  .scratch = *scratch_,
                  .progress = progress_,
                  .threads = dem_options_.threads,
                  .ranks = ranks_},
                 statistics_);
    if (is_first_rank()) {
      write();
    } else {
      with_threads(dem_options_.threads, [&] { send_raster(*dem_, *ranks_); });
    }
    return kExitDone;
  }

  BlockSink& begin(const TerrainHeader& header) override {
    check_crs(header.crs);
    crs_ = header.crs.empty() ? like_.crs : header.crs;
    dem_options_.max_edge = header.max_edge;
    dem_.emplace(dem_options_, header.lattice, *scratch_);
    // What is too large is told before the points are read.
    if (!wants_extent()) dem_->begin(Box<2>{});
    return writer_.emplace(*dem_);
  }

  [[nodiscard]] bool wants_extent() const override {
    return !dem_options_.grid.bounds && !dem_options_.grid.given;
  }
  [[nodiscard]] bool needs_heights() const override {
    return std::ranges::any_of(dem_options_.products,
                               [](DemProduct product) { return product != DemProduct::kDensity; });
  }
  void extent_known(const Box<2>& extent, std::uint64_t vertices) override {
    if (!wants_extent()) return;
    check_size(extent, vertices);
    dem_->begin(extent);
  }
  void add_merged(const MergedPart& part) override { paint_merged(*dem_, part); }

 private:
  using Clock = std::chrono::steady_clock;

  void check_crs(const std::string& crs) const {
    if (crs.empty() || like_.crs.empty() || options_.input.force_crs) return;
    if (gdal().same_crs(crs, like_.crs)) return;
    throw Error(fmt::format("{} is in {}, but {} in {}; reproject one of them (or --force-crs)",
                            options_.inputs.front(), gdal().crs_name(crs), options_.like,
                            gdal().crs_name(like_.crs)));
  }

  /// Refuses a raster that is large because of points far away, unless that is wanted: it has many
  /// pixels, and thousands for each vertex. Says how large it is if there are hundreds.
  void check_size(const Box<2>& extent, std::uint64_t vertices) {
    constexpr double kManyPixels = 1e7;
    constexpr double kManyForAVertex = 100;
    constexpr double kTooManyForAVertex = 2000;
    const Box<2> box = dem_->in_output(extent);
    const PixelGrid grid = choose_grid(dem_options_.grid, box);
    const double pixels = static_cast<double>(grid.columns) * grid.rows;
    const double for_each = pixels / static_cast<double>(vertices);
    if (pixels <= kManyPixels || for_each <= kManyForAVertex) return;
    if (options_.force_size || for_each <= kTooManyForAVertex) {
      progress_.say(fmt::format(
          "the raster has {} x {} pixels, for {} vertices; some of them may lie far away (--bounds "
          "says what to cover)",
          grid.columns, grid.rows, vertices));
      return;
    }
    throw Error(fmt::format(
        "the points, {} of them, reach from {:.15g}, {:.15g} to {:.15g}, {:.15g}: that is a raster "
        "of {} x {} pixels, {:.2g} for each of them, as if some lay far away; say what to cover "
        "with --bounds xmin,ymin,xmax,ymax, give a larger --resolution, or make it as it is with "
        "--force-size",
        vertices, box.lo[0], box.lo[1], box.hi[0], box.hi[1], grid.columns, grid.rows, for_each));
  }

  void write() {
    Dem& dem = *dem_;
    StreamFigures& stream = statistics_.stream;
    stream.left_out += dem.left_out();
    stream.threads = dem_options_.threads;
    RasterOptions raster = dem.raster_options();
    raster.path = options_.output;
    raster.grid.crs = crs_;
    raster.compression = options_.compression;
    raster.cloud_optimized = options_.cloud_optimized;
    progress_.begin("write", "pixels");
    RasterFile file(std::move(raster));
    const double pixels = static_cast<double>(dem.grid().columns) * dem.grid().rows;
    const auto progress = [&](std::uint64_t done) {
      progress_.update(done, static_cast<double>(done) / pixels);
    };
    with_threads(dem_options_.threads, [&] {
      if (ranks_ != nullptr) {
        write_raster_of_ranks(dem, file.raster(), progress, *ranks_);
      } else {
        dem.write(file.raster(), progress);
      }
    });
    statistics_.output_bytes = file.finish();
    statistics_.write_seconds = progress_.end(std::uint64_t{dem.grid().columns} * dem.grid().rows);
    statistics_.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    report(dem);
  }

  void report(const Dem& dem) {
    const PixelGrid& grid = dem.grid();
    const StreamFigures& stream = statistics_.stream;
    if (stream.left_out > 0) {
      progress_.say(fmt::format("{} triangles with an edge longer than {} left out",
                                stream.left_out, *statistics_.max_edge));
    }
    if (dem.spilled_bytes() > 0) {
      progress_.detail(
          fmt::format("{} of pixels on the disk", memory_size_text(dem.spilled_bytes())));
    }
    if (dem.pixels_with_data() == 0) {
      progress_.insist("warning: no pixel has a value: the raster lies beside the points");
    }
    progress_.say(
        fmt::format("{} vertices, {} triangles; {} x {} pixels of {}, {} with data, "
                    "{:.2f} s",
                    stream.totals.vertices, stream.totals.simplices, grid.columns, grid.rows,
                    grid.resolution, dem.pixels_with_data(), statistics_.seconds));
    if (options_.stats_path.empty()) return;
    Json json = to_json(statistics_);
    json["raster"] = {{"columns", grid.columns},
                      {"rows", grid.rows},
                      {"resolution", grid.resolution},
                      {"west", grid.west},
                      {"north", grid.north},
                      {"bands", dem.raster_options().bands},
                      {"pixels_with_data", dem.pixels_with_data()},
                      {"spilled_bytes", dem.spilled_bytes()}};
    write_text(options_.stats_path, json_text(json, 2) + "\n");
  }

  const Clock::time_point start_ = Clock::now();
  const DemCommandOptions& options_;
  RasterGrid like_;
  DemOptions dem_options_;
  std::uint64_t limit_;
  MemoryBudget budget_;
  const distributed::Ranks* const ranks_ = join_ranks();
  std::unique_ptr<ScratchFolder> scratch_;
  Progress progress_;
  std::string crs_;
  std::optional<Dem> dem_;
  std::optional<DemWriter> writer_;
  RunStatistics statistics_;
};

int run(const DemCommandOptions& options) {
  if (!can_be_tried(options.output)) {
    throw UsageError(fmt::format("-o {}: a GeoTIFF is not written in one go, so it needs a file",
                                 options.output));
  }
  if (!kGeoTiff.is_named(options.output)) {
    throw UsageError(fmt::format("-o {}: a DEM is a GeoTIFF: give it a name that ends in .{}",
                                 options.output, kGeoTiff.extensions.front()));
  }
  if (options.output == options.stats_path) {
    throw UsageError("the raster and --stats cannot go to the same place: " + options.output);
  }
  if (is_first_rank()) {
    check_can_create(disk(), options.output);
    if (!options.stats_path.empty()) check_can_create(disk(), options.stats_path);
  }
  RasterOptions raster;
  raster.name = options.output;
  raster.compression = options.compression;
  raster.cloud_optimized = options.cloud_optimized;
  gdal().check_raster_driver(raster);
  return Run(options).run();
}

}  // namespace

Subcommand add_dem(CommandLine& root) {
  const auto options = std::make_shared<DemCommandOptions>();
  CommandLine& app = root.add_subcommand("dem", "Make a raster of heights, slopes or shades");
  app.set_footer(kExamples);
  add_dem_options(app, *options);
  return {&app, [options] { return run(*options); }, true};
}

}  // namespace spillway::detail

#include <spillway/height.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "src/error.h"
#include "src/parallel/parallel.h"
#include "src/runtime/freed_memory.h"
#include "src/terrain/lattice_steps.h"
#include "stream/ground/ground_writer.h"
#include "stream/ground/repeated_points.h"
#include "stream/ground/waiting_points.h"
#include "stream/library/context/context_state.h"
#include "stream/library/convert_points.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/library/own_parts.h"
#include "stream/library/points/point_file.h"
#include "stream/library/points/program_points.h"
#include "stream/library/products/heights_above_ground.h"
#include "stream/library/products/surface_units.h"
#include "stream/source/joined_inputs.h"

namespace spillway::stream {
namespace {

/// The part of the memory that is for points.
constexpr std::uint64_t kPointShare = 2;

/// Of a file, also makes it hold heights.
void check(const HeightOptions& options, spillway::PointSink& sink) {
  if (options.replace_z && !std::isfinite(options.nodata)) {
    throw InvalidArgument("points without ground need a number as z: choose a value for no data");
  }
  if (std::isinf(options.nodata)) {
    throw InvalidArgument("the value for no data is a number, or not a number, but not infinite");
  }
  if ((options.min_height && std::isnan(*options.min_height)) ||
      (options.max_height && std::isnan(*options.max_height))) {
    throw InvalidArgument("the least and the greatest height are numbers");
  }
  if (options.min_height && options.max_height && !(*options.min_height <= *options.max_height)) {
    throw InvalidArgument(fmt::format("no height is {} at least and {} at most",
                                      *options.min_height, *options.max_height));
  }
  auto* const file = OwnParts::of(sink);
  if (options.replace_z || file == nullptr) return;
  if (!file->holds_attributes()) {
    throw InvalidArgument(fmt::format(
        "{} points have no attributes, so heights must take the place of z", file->title()));
  }
  file->want(kHeightAttribute);
}

/// Points in the coordinates of the triangles, without what they carry.
class PlacedOverGround final : public PointFeed {
 public:
  PlacedOverGround(RepeatedPoints& points, const std::optional<IntegerLattice>& ground,
                   RunWatch& watch)
      : points_(points), ground_(ground), watch_(watch) {}

  bool fetch(SourcePiece& piece) override {
    watch_.tell(points_.points_read(), points_.fraction_read());
    return points_.fetch(piece);
  }
  void decode(SourcePiece& piece, PointBlock& block) override {
    points_.decode(piece, block);
    block.attributes.clear();
    for (LatticePoint& point : block.points) point = placed(point);
  }

  [[nodiscard]] std::optional<Box<3>> extent() const {
    const std::optional<Box<3>>& extent = points_.extent();
    if (!extent) return std::nullopt;
    Box<3> box;
    box.expand(placed(LatticePoint(extent->lo)).numbers());
    box.expand(placed(LatticePoint(extent->hi)).numbers());
    return box;
  }

 private:
  [[nodiscard]] LatticePoint placed(const LatticePoint& point) const {
    if (points_.lattice() == ground_) return {point[0], point[1], 0};
    const WorldPoint world = in_world(points_.lattice(), point);
    if (!ground_) return {world[0], world[1], 0};
    return {lattice_steps(*ground_, 0, world[0]), lattice_steps(*ground_, 1, world[1]), 0};
  }

  RepeatedPoints& points_;
  const std::optional<IntegerLattice> ground_;
  RunWatch& watch_;
};

/// Takes the ground's triangles, and gives points with heights to a sink when all have come.
class HeightSink final : public OwnSink<spillway::MeshSink> {
 public:
  /// All must outlive it.
  HeightSink(EnginePoints& points, spillway::PointSink& sink, const HeightOptions& options,
             const Context& context, RunWatch& watch)
      : OwnSink(context),
        points_(points),
        carried_(prepare_for(sink, points)),
        sink_(sink),
        options_(options),
        watch_(watch),
        freed_(own_memory(context.memory())),
        scratch_(context.state().scratch(context)) {}

  [[nodiscard]] std::uint64_t own_memory(std::uint64_t limit) const override {
    return limit / kPointShare;
  }
  [[nodiscard]] CrsNeed crs_need() const override { return CrsNeed::kAll; }
  void identify(RunIdentity& identity) const override { identify_product("heights", "", identity); }

  BlockSink* begin_again() override {
    repeated_->repeat();
    return &deal();
  }

  void finalize(RunWatch& watch, Report& report, OtherShares& /*others*/) override {
    writer_->finish(report.mesh);
    watch.begin("locate", "points");
    const auto all = static_cast<double>(waiting_->points());
    with_threads(context().threads(), [&] {
      waiting_->finish(
          [&](std::uint64_t points) { watch.tell(points, static_cast<double>(points) / all); });
    });
    watch.end(waiting_->points());
    const std::unique_ptr<GroundHeights> found = waiting_->take_heights();
    report_.spilled_bytes =
        waiting_->spilled_bytes() + found->spilled_bytes() + repeated_->kept_bytes();
    writer_.reset();
    waiting_.reset();
    freed_.give_back(context().memory());  // writing has its own needs
    write(*found, watch);
  }

  /// When all is done; but for what is about the ground.
  [[nodiscard]] const HeightReport& report() const { return report_; }

 private:
  BlockSink& open(const MeshStart& start) override {
    refuse_tetrahedra(start);
    refuse_without_heights(start);
    lattice_ = start.header.lattice;
    run_ = points_.begin(watch_, false);
    if (!run_.has_heights) {
      throw Failure(run_.name.empty() ? "the points have no z" : run_.name + ": points have no z",
                    ErrorCode::kDegenerateInput);
    }
    if (!options_.foreign_crs) {
      check_same_crs(run_.name, run_.crs, "the ground, " + start.name + ",", start.header.crs,
                     run_.name);
    }
    const bool can_read_again =
        run_.files != nullptr && run_.files->any_order() && !run_.files->thins();
    repeated_.emplace(*run_.stream, can_read_again, *scratch_);
    if (repeated_->reads_again()) run_.files->carry({});  // the first time their places will do
    return deal();
  }

  void write(const GroundHeights& ground, RunWatch& watch) {
    if (repeated_->reads_again()) run_.files->carry(carried_);
    repeated_->repeat();
    HeightsAboveGround heights(run_, *repeated_, ground, options_);
    PointConversion passed = pass_on(heights.run(), "write", sink_, context(), watch);
    if (run_.files != nullptr) passed.skipped_files = run_.files->skipped();
    const std::uint64_t spilled = report_.spilled_bytes;
    report_ = heights.report();
    report_.points = std::move(passed);
    report_.spilled_bytes = spilled;
  }

  BlockSink& deal() {
    PlacedOverGround placed(*repeated_, lattice_, watch_);
    writer_.reset();
    waiting_.emplace(WaitingPointsOptions{.memory = own_memory(context().memory()),
                                          .whole = context().memory(),
                                          .threads = context().threads(),
                                          .expected = repeated_->expected(),
                                          .extent = placed.extent()},
                     *scratch_);
    watch_.begin("deal", "points");
    with_threads(context().threads(),
                 [&] { waiting_->deal(placed, [&] { return repeated_->numbers(); }); });
    watch_.end(waiting_->points());
    return writer_.emplace(lattice_, *waiting_);
  }

  EnginePoints& points_;
  const AttributeChoice carried_;  ///< by points as they are written
  spillway::PointSink& sink_;
  const HeightOptions& options_;
  RunWatch& watch_;
  FreedMemory freed_;  ///< the process may hold this part of the memory, too
  std::shared_ptr<ScratchFolder> scratch_;
  RunPoints run_;
  std::optional<IntegerLattice> lattice_;  ///< of the ground
  std::optional<RepeatedPoints> repeated_;
  std::optional<WaitingPoints> waiting_;
  std::optional<GroundWriter> writer_;
  HeightReport report_;
};

/// The path of a file among the scratch files, for as long as it lives.
class ScratchPath {
 public:
  ScratchPath(const Context& context, const std::string& name)
      : scratch_(context.state().scratch(context)), beside_(scratch_->create(name)) {
    path_ = beside_->name() + ".spp";
  }
  ~ScratchPath() { std::filesystem::remove(path_, ignored_); }
  ScratchPath(const ScratchPath&) = delete;
  ScratchPath& operator=(const ScratchPath&) = delete;

  [[nodiscard]] const std::string& get() const { return path_; }

 private:
  std::shared_ptr<ScratchFolder> scratch_;
  std::unique_ptr<ScratchFile> beside_;  ///< for which the folder is there
  std::string path_;
  std::error_code ignored_;
};

/// Whether an input is a pipe or the like.
bool can_be_read_once(const std::string& path) {
  std::error_code unknown;
  const auto kind = std::filesystem::status(path, unknown).type();
  return path == "-" || kind == std::filesystem::file_type::fifo ||
         kind == std::filesystem::file_type::character ||
         kind == std::filesystem::file_type::socket;
}

/// Writes all points to a file, whatever filters there are. Returns what became of them.
PointConversion copy_points(const std::vector<std::string>& paths, const PointOptions& options,
                            const std::string& to, const Context& context) {
  PointOptions all;
  all.dimension = 0;
  all.format = options.format;
  all.text = options.text;
  all.skip_invalid = options.skip_invalid;
  all.max_expansion = options.max_expansion;
  all.keep_withheld = true;
  all.crs = options.crs;
  all.foreign_crs = options.foreign_crs;
  all.salvage = options.salvage;
  all.skip_broken = options.skip_broken;
  const auto source = open_points(paths, all, context);
  const auto copy = create_points(to, {}, context);
  return convert(*source, *copy, context);
}

/// Points in a scratch file, which goes with them.
class ScratchPoints final : public PointSource {
 public:
  ScratchPoints(std::unique_ptr<ScratchPath> path, const Context& context)
      : path_(std::move(path)), points_(open_points({path_->get()}, {.dimension = 2}, context)) {}

  [[nodiscard]] PointsHeader header() const override { return points_->header(); }
  bool read(std::vector<spillway::Point<3>>& points) override { return points_->read(points); }
  bool read(spillway::PointsBlock& block) override { return points_->read(block); }

 private:
  EnginePoints* engine_points() override { return OwnParts::of(*points_); }

  std::unique_ptr<ScratchPath> path_;
  std::unique_ptr<PointSource> points_;
};

/// Options of the ground among points: it is there whatever is wanted of the others.
PointOptions ground_options(const PointOptions& points, const std::vector<int>& classes) {
  PointOptions ground = points;
  ground.dimension = 2;
  ground.classes = classes;
  ground.other_classes.clear();
  ground.every = 1;
  ground.returns.reset();
  ground.where.clear();
  ground.bounds.reset();
  ground.z_range.reset();
  ground.clip = {};
  ground.thin.reset();
  ground.resolution = 0;
  ground.metadata = false;
  ground.attributes.clear();
  return ground;
}

/// `send` gives the ground to a sink.
HeightReport measure(PointSource& source, spillway::PointSink& sink, const HeightOptions& options,
                     const Context& context,
                     const std::function<Report(spillway::MeshSink& ground)>& send) {
  check(options, sink);
  if (context.options().executor != nullptr) {
    throw InvalidArgument("heights are measured by one process, not by several");
  }
  RunWatch watch(context);
  watch.check();
  std::optional<ProgramPoints> program_points;
  auto* points = OwnParts::of(source);
  if (points == nullptr) points = &program_points.emplace(source, 0);
  HeightSink heights(*points, sink, options, context, watch);
  const Report ground = send(heights);
  HeightReport report = heights.report();
  report.ground = ground;
  return report;
}

}  // namespace
}  // namespace spillway::stream

namespace spillway {

HeightReport measure_heights(PointSource& points, PointSource& ground, PointSink& sink,
                             const HeightOptions& options, const TriangulateOptions& how,
                             const Context& context) {
  return stream::measure(points, sink, options, context, [&](MeshSink& heights) {
    return triangulate(ground, heights, how, context);
  });
}

HeightReport measure_heights(PointSource& points, MeshSource& ground, PointSink& sink,
                             const HeightOptions& options, const Context& context) {
  return stream::measure(points, sink, options, context,
                         [&](MeshSink& heights) { return convert(ground, heights, context); });
}

HeightReport measure_heights(const std::vector<std::string>& paths, const PointOptions& points,
                             const std::vector<int>& ground_classes, PointSink& sink,
                             const HeightOptions& options, const TriangulateOptions& how,
                             const Context& context) {
  if (ground_classes.empty()) {
    throw runtime::InvalidArgument("the ground has at least one class, and none is given");
  }
  PointOptions wanted = points;
  std::vector<std::string> files = paths;
  std::optional<stream::ScratchPath> copy;
  std::vector<SkippedFile> skipped;
  if (std::ranges::any_of(paths, stream::can_be_read_once)) {
    if (!how.resume_folder.empty()) {
      throw runtime::InvalidArgument("points of a pipe cannot be gone on with: give files");
    }
    files = {copy.emplace(context, "input").get()};
    skipped = stream::copy_points(paths, points, files[0], context).skipped_files;
    wanted.format = "spp";
    wanted.text = {};
    wanted.skip_invalid = wanted.salvage = wanted.skip_broken = false;
  }
  const auto source = open_points(files, wanted, context);
  const auto ground = open_points(files, stream::ground_options(wanted, ground_classes), context);
  HeightReport report = measure_heights(*source, *ground, sink, options, how, context);
  if (copy) report.points.skipped_files = skipped;
  return report;
}

PointsAboveGround open_above_ground(const std::vector<std::string>& paths,
                                    const PointOptions& points,
                                    const std::vector<int>& ground_classes,
                                    const HeightOptions& options, const TriangulateOptions& how,
                                    const Context& context) {
  auto path = std::make_unique<stream::ScratchPath>(context, "heights");
  HeightOptions of_heights = options;
  of_heights.replace_z = true;
  PointsAboveGround above;
  {
    const auto file = create_points(path->get(), {}, context);
    above.report = measure_heights(paths, points, ground_classes, *file, of_heights, how, context);
  }
  above.points = std::make_unique<stream::ScratchPoints>(std::move(path), context);
  return above;
}

}  // namespace spillway

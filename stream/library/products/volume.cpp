#include <spillway/volume.h>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/gdal/gdal.h"
#include "src/error.h"
#include "src/geometry/longest_edge.h"
#include "src/parallel/parallel.h"
#include "src/runtime/freed_memory.h"
#include "src/terrain/overlay_volume.h"
#include "stream/ground/overlay_cells.h"
#include "stream/library/context/context_state.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/library/products/surface_units.h"
#include "stream/sinks/simplex_sink.h"

namespace spillway::stream {
namespace {

/// The part of the memory that is for triangles.
constexpr std::uint64_t kTriangleShare = 2;
constexpr std::size_t kTrianglesAtATime = 4096;

/// Gives the triangles of a mesh, in output coordinates and canonical order, to whoever takes them.
class SurfaceWriter final : public SimplexSink<WorldPoint> {
 public:
  /// Called by many threads at once.
  using Take = std::function<void(std::span<const Triangle>)>;

  SurfaceWriter(const std::optional<IntegerLattice>& lattice, double z_factor,
                std::optional<double> max_edge, Take take)
      : SimplexSink(2),
        lattice_(lattice),
        z_factor_(z_factor),
        max_edge_(max_edge),
        take_(std::move(take)) {}

  /// Triangles with too long an edge.
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }

 private:
  [[nodiscard]] std::vector<WorldPoint> values_of(
      std::span<const LatticePoint> vertices) const override {
    std::vector<WorldPoint> placed;
    placed.reserve(vertices.size());
    for (const LatticePoint& vertex : vertices) {
      placed.push_back(in_world(lattice_, vertex));
      placed.back()[2] *= z_factor_;
    }
    return placed;
  }
  void take_vertices(std::span<const WorldPoint> /*vertices*/) override {}
  void take_simplices(std::span<const WorldPoint> vertices,
                      std::span<const std::uint32_t> corners) override {
    const auto take_some = [&](std::size_t /*grain*/, std::size_t begin, std::size_t end) {
      std::vector<Triangle> triangles;
      triangles.reserve(end - begin);
      for (std::size_t t = begin; t < end; ++t) {
        const std::uint32_t* const v = &corners[3 * t];
        const Triangle triangle = in_canonical_order(
            {vertices[v[0]].numbers(), vertices[v[1]].numbers(), vertices[v[2]].numbers()});
        if (max_edge_ && has_longer_edge<2>(triangle, *max_edge_)) {
          ++left_out_;
        } else {
          triangles.push_back(triangle);
        }
      }
      take_(triangles);
    };
    // Isolated: the caller may hold what another of its tasks would wait for.
    isolated([&] { parallel_for(corners.size() / 3, kTrianglesAtATime, take_some); });
  }

  const std::optional<IntegerLattice> lattice_;
  const double z_factor_;
  const std::optional<double> max_edge_;
  const Take take_;
  std::atomic<std::uint64_t> left_out_ = 0;
};

void check(const VolumeOptions& options) {
  check_max_edge(options.max_edge);
  check_z_factor(options.z_factor);
}

/// What brings heights to the unit of x and y. Throws Failure for longitude and latitude.
double z_factor_of(const MeshStart& start, const VolumeOptions& options, const Context& context) {
  if (start.header.crs.empty()) return options.z_factor.value_or(1);
  const CrsUnits units = gdal().crs_units(start.header.crs);
  if (units.is_geographic && !options.foreign_crs) {
    throw Failure(fmt::format("{} is in {}, whose longitude and latitude are no lengths: reproject "
                              "it, or take coordinates as they are",
                              start.name, gdal().crs_name(start.header.crs)),
                  ErrorCode::kBadInput, {.file = start.name, .remedy = Remedy::kForeignCrs});
  }
  if (options.z_factor) return *options.z_factor;
  const double factor = units.is_geographic ? 1 : z_factor_by(units);
  if (factor == 1) return 1;
  if (context.options().detail) {
    context.options().detail(fmt::format("{}: heights are multiplied by {:.12g}",
                                         gdal().crs_name(start.header.crs), factor));
  }
  return factor;
}

/// A surface whose triangles something is derived from.
template <typename PublicSink>
class SurfaceSink : public OwnSink<PublicSink> {
 public:
  SurfaceSink(const VolumeOptions& options, const Context& context)
      : OwnSink<PublicSink>(context), options_(options) {}

  [[nodiscard]] CrsNeed crs_need() const override { return CrsNeed::kAll; }
  void identify(RunIdentity& identity) const override { identify_product("volume", "", identity); }
  BlockSink* begin_again() override {
    forget();
    return &writer_.emplace(lattice_, z_factor_, max_edge_,
                            [this](std::span<const Triangle> triangles) { take(triangles); });
  }
  void finalize(RunWatch& /*watch*/, Report& report, OtherShares& /*others*/) override {
    writer_->finish(report.mesh);
    report.left_out += writer_->left_out();
    is_complete_ = true;
  }

  [[nodiscard]] bool is_complete() const { return is_complete_; }
  [[nodiscard]] const VolumeOptions& options() const { return options_; }
  [[nodiscard]] const std::string& crs() const { return crs_; }
  /// What its heights are multiplied by.
  [[nodiscard]] double z_factor() const { return z_factor_; }
  [[nodiscard]] const std::optional<IntegerLattice>& lattice() const { return lattice_; }

 protected:
  BlockSink& open(const MeshStart& start) override {
    refuse_tetrahedra(start);
    refuse_without_heights(start);
    crs_ = start.header.crs;
    lattice_ = start.header.lattice;
    if (!start.is_triangulated) max_edge_ = options_.max_edge;
    z_factor_ = choose_z_factor(start);
    return *begin_again();
  }

 private:
  [[nodiscard]] virtual double choose_z_factor(const MeshStart& start) const {
    return z_factor_of(start, options_, this->context());
  }
  /// All triangles that have come are void.
  virtual void forget() {}
  /// By many threads at once.
  virtual void take(std::span<const Triangle> triangles) = 0;

  VolumeOptions options_;
  std::string crs_;
  std::optional<IntegerLattice> lattice_;
  std::optional<double> max_edge_;
  double z_factor_ = 1;
  std::optional<SurfaceWriter> writer_;
  bool is_complete_ = false;
};

class LevelSink final : public SurfaceSink<LevelVolumeSink> {
 public:
  LevelSink(double level, const VolumeOptions& options, const Context& context)
      : SurfaceSink(options, context), level_(level) {
    check(options);
    if (!std::isfinite(level)) throw InvalidArgument("a level is a finite number");
  }

  [[nodiscard]] Volume volume() const override {
    return {.cut = sums_.cut.value(),
            .fill = sums_.fill.value(),
            .cut_area = sums_.cut_area.value(),
            .fill_area = sums_.fill_area.value(),
            .area = sums_.area.value(),
            .first_area = sums_.area.value()};
  }

 private:
  void forget() override { sums_ = {}; }
  void take(std::span<const Triangle> triangles) override {
    VolumeSums some;
    for (const Triangle& triangle : triangles) add_above(triangle, level_ * z_factor(), some);
    const std::lock_guard lock(mutex_);
    sums_.add(some);
  }

  const double level_;
  std::mutex mutex_;  ///< guards the next one
  VolumeSums sums_;
};

/// One of two surfaces, which brings its triangles to the cells of both.
class OneOfTwo final : public SurfaceSink<spillway::MeshSink> {
 public:
  /// Called when the surface begins, and when it is known where it lies.
  struct Told {
    std::function<double(const MeshStart& start)>
        begins;  ///< returns what heights are multiplied by
    std::function<void(const Box<2>& extent, std::uint64_t vertices)> extent;
    std::function<void(std::span<const Triangle> triangles)> triangles;
  };

  OneOfTwo(Told told, const VolumeOptions& options, const Context& context)
      : SurfaceSink(options, context), told_(std::move(told)) {}

  [[nodiscard]] std::uint64_t own_memory(std::uint64_t limit) const override {
    return limit / kTriangleShare;
  }
  /// So no block comes before it is certain that none is taken back.
  [[nodiscard]] bool wants_extent() const override { return true; }
  void extent_known(const Box<2>& extent, std::uint64_t vertices) override {
    Box<2> box;
    for (const Point<2>& corner : {extent.lo, extent.hi}) {
      box.expand(
          lattice() ? Point<2>{lattice()->to_world(0, corner[0]), lattice()->to_world(1, corner[1])}
                    : corner);
    }
    told_.extent(box, vertices);
  }

  BlockSink* begin_again() override { return has_come_ ? nullptr : SurfaceSink::begin_again(); }

  [[nodiscard]] double area() const { return area_.value(); }

 private:
  [[nodiscard]] double choose_z_factor(const MeshStart& start) const override {
    return told_.begins(start);
  }
  void take(std::span<const Triangle> triangles) override {
    has_come_ = true;
    ExactSum some;
    for (const Triangle& triangle : triangles) some.add(plane_area(triangle));
    told_.triangles(triangles);
    const std::lock_guard lock(mutex_);
    area_.add(some);
  }

  const Told told_;
  std::atomic<bool> has_come_ = false;  ///< some triangle
  std::mutex mutex_;                    ///< guards the next one
  ExactSum area_;
};

class BetweenTwo final : public VolumeBetween {
 public:
  BetweenTwo(const VolumeOptions& options, const Context& context)
      : context_(context),
        options_(options),
        freed_(context.memory() / kTriangleShare),
        scratch_(context.state().scratch(context)),
        first_(
            {.begins =
                 [this](const MeshStart& start) { return z_factor_of(start, options_, context_); },
             .extent =
                 [this](const Box<2>& extent, std::uint64_t vertices) {
                   cells_.emplace(extent, 2 * vertices, context_.memory() / kTriangleShare,
                                  context_.threads(), *scratch_);
                 },
             .triangles = [this](std::span<const Triangle> some) { cells_->add(0, some); }},
            options, context),
        second_({.begins = [this](const MeshStart& start) { return factor_of_second(start); },
                 .extent = [](const Box<2>& /*extent*/, std::uint64_t /*vertices*/) {},
                 .triangles = [this](std::span<const Triangle> some) { cells_->add(1, some); }},
                options, context) {
    check(options);
  }

  [[nodiscard]] spillway::MeshSink& first() override { return first_; }
  [[nodiscard]] spillway::MeshSink& second() override { return second_; }

  [[nodiscard]] Volume measure() override {
    if (!first_.is_complete() || !second_.is_complete()) {
      throw InvalidArgument("a volume lies between two surfaces, and one has not come");
    }
    RunWatch watch(context_);
    watch.begin("overlay", "cells");
    VolumeSums sums;
    with_threads(context_.threads(), [&] {
      sums = cells_->between([&](std::uint64_t done) {
        watch.tell(done, static_cast<double>(done) / static_cast<double>(cells_->cells()));
      });
    });
    watch.end(cells_->cells());
    return {.cut = sums.cut.value(),
            .fill = sums.fill.value(),
            .cut_area = sums.cut_area.value(),
            .fill_area = sums.fill_area.value(),
            .area = sums.area.value(),
            .first_area = first_.area(),
            .second_area = second_.area(),
            .spilled_bytes = cells_->spilled_bytes()};
  }

 private:
  /// Of surfaces of which one tells no coordinate system it is that of the other.
  [[nodiscard]] double factor_of_second(const MeshStart& start) const {
    if (!first_.is_complete()) throw InvalidArgument("the first surface comes first");
    const std::string& crs = start.header.crs;
    if (crs.empty()) return first_.z_factor();
    const double factor = z_factor_of(start, options_, context_);
    if (first_.crs().empty() && factor != first_.z_factor()) {
      throw Failure(
          fmt::format("{} has heights in another unit than x and y, and the first surface names no "
                      "coordinate system that tells so, too",
                      start.name),
          ErrorCode::kBadInput, {.file = start.name, .remedy = Remedy::kGroundScale});
    }
    if (!options_.foreign_crs) {
      check_same_crs("the first surface", first_.crs(), start.name, crs, start.name);
    }
    return factor;
  }

  const Context context_;
  const VolumeOptions options_;
  const FreedMemory freed_;  ///< the process may hold this part of the memory, too
  std::shared_ptr<ScratchFolder> scratch_;
  std::optional<OverlayCells> cells_;
  OneOfTwo first_;
  OneOfTwo second_;
};

}  // namespace
}  // namespace spillway::stream

namespace spillway {

VolumeBetween::~VolumeBetween() = default;

std::unique_ptr<VolumeBetween> measure_between(const VolumeOptions& options,
                                               const Context& context) {
  return std::make_unique<stream::BetweenTwo>(options, context);
}

std::unique_ptr<LevelVolumeSink> measure_above(double level, const VolumeOptions& options,
                                               const Context& context) {
  return std::make_unique<stream::LevelSink>(level, options, context);
}

}  // namespace spillway

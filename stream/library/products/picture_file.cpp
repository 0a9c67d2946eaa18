#include "stream/library/products/picture_file.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "formats/disk/output_check.h"
#include "formats/rasters/png.h"
#include "formats/rasters/raster_formats.h"
#include "src/parallel/parallel.h"
#include "src/runtime/memory_budget.h"
#include "stream/library/choice_check.h"
#include "stream/library/context/context_state.h"
#include "stream/plan/memory_plan.h"

namespace spillway::stream {
namespace {

constexpr std::uint64_t kLeastMemory = std::uint64_t{64} << 20;
/// The part of the memory that is for pixels while triangles come.
constexpr std::uint64_t kPixelShare = 4;
/// What a pixel takes while the picture is drawn, when the mesh has gone through; and the part of
/// the memory that is there for it.
constexpr std::uint64_t kBytesOfAPixel = 16;
constexpr std::uint64_t kPictureShare = 2;

void check(const PictureOptions& options) {
  if (options.size < kLeastPictureSize || options.size > kMostPictureSize) {
    throw InvalidArgument(fmt::format("a picture has {} to {} pixels a side, not {}",
                                      kLeastPictureSize, kMostPictureSize, options.size));
  }
  if (options.zoom) {
    const auto& [low, high] = *options.zoom;
    if (!(low[0] < high[0] && low[1] < high[1])) {
      throw InvalidArgument("a zoom is a box of some area: xmin, ymin, xmax, ymax");
    }
  }
  if (options.exaggeration && !(*options.exaggeration > 0)) {
    throw InvalidArgument("heights are exaggerated by a number above 0");
  }
  if (options.view && !(std::abs((*options.view)[1]) <= 90)) {
    throw InvalidArgument("a view has an elevation from -90 to 90 degrees");
  }
  if (options.slice && (options.slice->axis < 0 || options.slice->axis > 2)) {
    throw InvalidArgument("a slice is across axis 0, 1 or 2");
  }
}

void check_memory(std::uint32_t size, std::uint64_t limit) {
  if (limit < kLeastMemory) {
    throw TooSmallLimit("the memory limit is too small: 64 MiB are the least for a picture",
                        {.enough = kLeastMemory, .remedy = Remedy::kMemory});
  }
  const std::uint64_t needed = std::uint64_t{size} * size * kBytesOfAPixel;
  if (needed <= limit / kPictureShare) return;
  throw TooSmallLimit(
      fmt::format("a picture of {} pixels a side may need {} of memory, half of the limit: make a "
                  "smaller one, or raise the limit",
                  size, memory_size_text(needed)),
      {.enough = kPictureShare * needed, .remedy = Remedy::kMemory});
}

}  // namespace

PictureFile::PictureFile(const std::string& path, const PictureOptions& options,
                         const Context& context)
    : OwnSink(context), path_(path), options_(options), scratch_(context.state().scratch(context)) {
  if (path_ != "-" && !kPng.is_named(path_)) {
    throw InvalidArgument(
        fmt::format("{}: pictures are written as .{} only", path_, kPng.extensions.front()));
  }
  check(options_);
  check_max_edge(options_.max_edge);
  check_memory(options_.size, context.memory());
  check_can_create(disk(), path_);
}

std::uint64_t PictureFile::own_memory(std::uint64_t limit) const { return limit / kPixelShare; }

unsigned PictureFile::feeding_threads(unsigned threads) const {
  const std::uint64_t limit = context().memory();
  return plan_memory(limit - own_memory(limit), 2, threads).threads;
}

BlockSink& PictureFile::open(const MeshStart& start) {
  dimension_ = start.header.dimension;
  refuse_higher_dimensions(dimension_, "a picture shows");
  mesh_ = {.lattice = start.header.lattice,
           .max_edge = start.is_triangulated ? std::nullopt : options_.max_edge};
  return *begin_again();
}

BlockSink* PictureFile::begin_again() {
  scene_.reset();
  scene_ = dimension_ == 2 ? make_relief_scene(options_, mesh_, own_memory(context().memory()),
                                               feeding_threads(context().threads()), *scratch_)
                           : make_space_scene(options_, mesh_);
  if (options_.zoom) scene_->extent_known({});
  return &scene_->writer();
}

void PictureFile::extent_known(const Box<2>& extent, std::uint64_t /*vertices*/) {
  if (wants_extent()) scene_->extent_known(extent);
}

void PictureFile::finalize(RunWatch& watch, Report& report, OtherShares& /*others*/) {
  scene_->writer().finish(report.mesh);
  watch.begin("draw", "pixels");
  std::optional<Picture> picture;
  with_threads(feeding_threads(context().threads()), [&] { picture = scene_->draw(); });
  if (!options_.transparent) picture->put_onto(kWhite);
  report_.columns = picture->columns();
  report_.rows = picture->rows();
  report.output_format = kPng.name;
  report.output_bytes = write_png(disk(), path_, report_.columns, report_.rows, picture->bytes(),
                                  options_.transparent);
  report.write_seconds = watch.end(std::uint64_t{report_.columns} * report_.rows);
  report.left_out += scene_->left_out();
  report_.description = scene_->description();
  report_.edges_too_small = scene_->edges_too_small();
}

}  // namespace spillway::stream

namespace spillway {

std::unique_ptr<PictureSink> create_picture(const std::string& path, const PictureOptions& options,
                                            const Context& context) {
  return std::make_unique<stream::PictureFile>(path, options, context);
}

}  // namespace spillway

#include "stream/library/file_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/error.h"
#include "stream/source/input_list.h"

namespace spillway::detail {
namespace {

PointFilter filter_of(const PointOptions& options) {
  PointFilter filter;
  if (options.every == 0) throw InvalidArgument("of every 0 records none can be used; give 1");
  filter.every = options.every;
  for (const int number : options.classes) {
    if (number < 0 || number > 255) {
      throw InvalidArgument(fmt::format("{} is no class of points: these are 0 to 255", number));
    }
    if (!filter.classes) filter.classes.emplace();
    filter.classes->set(static_cast<std::size_t>(number));
  }
  if (options.bounds) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(options.bounds->low[k] <= options.bounds->high[k])) {
        throw InvalidArgument(fmt::format("the bounds have a least {} of {}, but a most of {}",
                                          "xyz"[k], options.bounds->low[k],
                                          options.bounds->high[k]));
      }
    }
    filter.bounds = Box<3>{options.bounds->low, options.bounds->high};
  }
  return filter;
}

ThinningRequest thinning_of(const Thin& thin, std::uint64_t memory, ScratchFolder& scratch) {
  if (!(thin.cell > 0) || !std::isfinite(thin.cell)) {
    throw InvalidArgument(
        fmt::format("cells of {} do not thin points: give a side above 0", thin.cell));
  }
  ThinningRequest request;
  request.cell = thin.cell;
  switch (thin.choice) {
    case spillway::ThinChoice::kFirst:
      request.choice = ThinChoice::kFirst;
      break;
    case spillway::ThinChoice::kLowest:
      request.choice = ThinChoice::kLowest;
      break;
    case spillway::ThinChoice::kHighest:
      request.choice = ThinChoice::kHighest;
      break;
    case spillway::ThinChoice::kCenter:
      request.choice = ThinChoice::kCenter;
      break;
  }
  request.memory = memory / kThinningShare;
  request.scratch = &scratch;
  return request;
}

Extent extent_of(const Box<3>& box) { return {box.lo, box.hi}; }

}  // namespace

FilePoints::FilePoints(const std::vector<std::string>& paths, const PointOptions& options,
                       const Context& context)
    : dimension_(options.dimension),
      scratch_(make_scratch_folder(context.options().scratch_folder, context.scratch_limit())) {
  if (options.dimension != 2 && options.dimension != 3) {
    throw InvalidArgument(fmt::format("there are 2 or 3 dimensions, not {}", options.dimension));
  }
  PointSourceOptions how;
  how.dimension = options.dimension;
  how.index = true;
  how.reader.format = options.format;
  how.reader.keep_withheld = options.keep_withheld;
  how.reader.resolution = options.resolution;
  how.filter = filter_of(options);
  if (options.thin) how.thinning = thinning_of(*options.thin, context.memory(), *scratch_);
  how.force_crs = options.foreign_crs;
  if (context.options().warning) how.warn = context.options().warning;
  if (context.options().detail) how.detail = context.options().detail;
  const std::vector<std::string> files = expand_inputs(paths, how.warn);
  if (files.empty()) throw InvalidArgument("there are no files to read points from");
  if (std::ranges::count(files, "-") > 1) {
    throw InvalidArgument("standard input can be read only once");
  }
  input_ = std::make_unique<detail::PointSource>(disk(), files, std::move(how));
}

PointsHeader FilePoints::header() const {
  PointsHeader header;
  header.coordinates = input_->has_heights() ? 3 : 2;
  header.count = input_->expected();
  if (input_->world_extent()) header.extent = extent_of(*input_->world_extent());
  header.crs = input_->crs();
  return header;
}

bool FilePoints::read(std::vector<spillway::Point<3>>& points) {
  PointBlock block;
  if (!input_->read(block)) return false;
  points = std::move(block.points);
  if (const std::optional<Lattice>& lattice = input_->lattice()) {
    for (auto& point : points) point = lattice->to_world(point);
  }
  return true;
}

}  // namespace spillway::detail

namespace spillway {

std::unique_ptr<PointSource> open_points(const std::vector<std::string>& paths,
                                         const PointOptions& options, const Context& context) {
  return std::make_unique<detail::FilePoints>(paths, options, context);
}

}  // namespace spillway

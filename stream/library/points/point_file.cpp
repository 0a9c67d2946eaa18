#include "stream/library/points/point_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <string_view>
#include <system_error>

#include "formats/gdal/gdal.h"
#include "formats/points/attributes/further_coordinates.h"
#include "formats/points/create_points.h"
#include "formats/points/las/records/las_metadata.h"
#include "formats/points/point_formats.h"
#include "src/error.h"
#include "src/geometry/lattice_check.h"
#include "src/parallel/parallel.h"
#include "stream/library/context/context_state.h"
#include "stream/library/points/lost_fields.h"
#include "stream/library/points/public_points.h"

namespace spillway::stream {
namespace {

const PointFormat& format_to_write(const std::string& path, const std::string& name) {
  return path == "-" && name.empty() ? own_point_stream() : point_format_to_write(path, name);
}

/// One number for all axes, or one each.
void check_axes(std::string_view what, const std::vector<double>& values) {
  if (values.size() == 2 || values.size() > 3) {
    throw InvalidArgument(
        fmt::format("a lattice has one {} for all axes, or three, not {}", what, values.size()));
  }
}

bool is_las(const PointHeader& header) { return header.point_format >= 0; }

/// LAS 1.4 where more points may come than others count, or from its point formats; empty where the
/// writer knows better, by what LAS inputs tell or by attributes.
std::string las_version_for(const RunPoints& points, bool has_metadata) {
  constexpr std::uint64_t kMostOfVersion12 = 4294967295;
  const bool many =
      points.stream != nullptr && points.stream->expected().value_or(0) > kMostOfVersion12;
  const bool extended = std::ranges::any_of(
      points.headers, [](const PointHeader& header) { return header.point_format >= 6; });
  if (many || (extended && !has_metadata)) return "1.4";
  return has_metadata || std::ranges::none_of(points.headers, is_las) ? "" : "1.2";
}

/// What all inputs that are LAS tell, if all are.
std::shared_ptr<const LasMetadata> las_metadata_of(const std::vector<PointHeader>& headers) {
  std::vector<std::shared_ptr<const LasMetadata>> all;
  for (const PointHeader& header : headers) {
    if (!header.las_metadata) return nullptr;
    all.push_back(header.las_metadata);
  }
  return joined(all);
}

/// Whether `crs` is what each input itself tells.
bool is_crs_of_all(const std::vector<PointHeader>& headers, const std::string& crs) {
  return std::ranges::all_of(headers, [&](const PointHeader& header) {
    return header.crs == crs && !header.is_transformed;
  });
}

/// `crs` as WKT if it is a code and GDAL is there to tell; else empty.
std::string wkt_of_code(const std::string& crs) {
  if (crs.empty() || crs.find('[') != std::string::npos) return "";
  try {
    return gdal().crs_to_wkt(crs);
  } catch (const Failure&) {  // LAS can tell the code alone too, or refuses it
    return "";
  }
}

}  // namespace

void share_out(std::size_t count, const WorkSharing::Body& body) {
  parallel_for(count, 1, [&](std::size_t i, std::size_t, std::size_t) { body(i); });
}

PointFile::PointFile(const std::string& path, const PointFileOptions& options,
                     const Context& context, FileSystem& files)
    : files_(files),
      path_(path),
      options_(options),
      format_(format_to_write(path, options.format)),
      scratch_(context.state().scratch(context)),
      threads_(context.threads()),
      memory_(context.memory()) {
  check(options);
}

PointFile::~PointFile() = default;

void PointFile::check(const PointFileOptions& options) const {
  const std::string& version = options.las_version;
  if (!version.empty() && !format_.has_versions) {
    throw InvalidArgument(fmt::format("only LAS and LAZ have versions, and {} is neither", path_));
  }
  if (!version.empty() && version != "1.2" && version != "1.4") {
    throw InvalidArgument(
        fmt::format("version {} of LAS is not written: choose 1.2 or 1.4", version));
  }
  if (options.sorted && !format_.holds_regions) {
    throw InvalidArgument(
        fmt::format("only spp can be sorted, and {} is {}", path_, format_.title));
  }
  if (options.sorted && options.sorted->dimension != 2 && options.sorted->dimension != 3) {
    throw InvalidArgument(
        fmt::format("points are sorted in 2 or 3 dimensions, not {}", options.sorted->dimension));
  }
  check_axes("scale", options.scale);
  check_axes("offset", options.offset);
  for (const double scale : options.scale) {
    if (!(scale > 0) || !std::isfinite(scale)) {
      throw InvalidArgument(fmt::format("no lattice has steps of {}: give a scale above 0", scale));
    }
  }
  for (const double offset : options.offset) {
    if (!std::isfinite(offset)) {
      throw InvalidArgument(fmt::format("no lattice begins at {}", offset));
    }
  }
}

void PointFile::want(const std::string& attribute) {
  const AttributeChoice chosen = wanted_attributes();
  if (chosen.all || std::ranges::find(chosen.names, attribute) != chosen.names.end()) return;
  if (!options_.attributes) options_.attributes.emplace();
  options_.attributes->push_back(attribute);
}

AttributeChoice PointFile::wanted_attributes() const {
  if (!format_.holds_attributes) return {};
  if (options_.attributes) return attribute_choice(*options_.attributes);
  return {.all = format_.writes_attributes == nullptr || format_.writes_attributes(path_)};
}

/// Throws Failure if the file is an input that would lose something.
void PointFile::check_overwriting(const RunPoints& points) const {
  if (options_.force || path_ == "-") return;
  const bool is_input = std::ranges::any_of(points.headers, [&](const PointHeader& header) {
    std::error_code unknown;
    return std::filesystem::equivalent(header.name, path_, unknown);
  });
  const bool same_lattice =
      how_.lattice && chosen_lattice({options_.scale, options_.offset}, how_.lattice,
                                     points.extent.value_or(Box<3>{})) == *how_.lattice;
  const bool holds_less = !lost_.empty() || (rounds_ && !same_lattice) || points.leaves_out;
  if (!is_input || !holds_less) return;
  const std::string what = !lost_.empty()      ? fmt::format("{}", fmt::join(lost_, ", "))
                           : points.leaves_out ? std::string("points that are left out")
                                               : std::string("digits that are rounded away");
  throw InvalidArgument(
      fmt::format("{} is an input, and would lose {}; choose another name", path_, what),
      {.file = path_, .remedy = Remedy::kForce});
}

/// Throws Failure for a name that is asked for and that no point has.
void PointFile::check_attributes(const RunPoints& points) const {
  if (!options_.attributes) return;
  if (!format_.holds_attributes && !options_.attributes->empty()) {
    throw InvalidArgument(fmt::format("{} holds no attributes of points, and {} is {}",
                                      format_.title, path_, format_.title));
  }
  refuse_unknown_names(*options_.attributes, points.offered);
}

void PointFile::start(const RunPoints& points, const WorkSharing& sharing) {
  if (begun_ || finished_) throw InvalidArgument("a file of points begins once");
  begun_ = true;
  how_.format = format_.name;
  adds_heights_ = !points.has_heights && format_.needs_heights;
  how_.coordinates = !points.has_heights && !adds_heights_ ? 2 : 3;
  how_.crs = points.crs;
  how_.scratch = scratch_.get();
  how_.sharing = sharing;
  how_.memory = memory_;
  how_.finishing = [this](std::uint64_t done) {
    if (finishing_) finishing_(done);
  };
  how_.by_regions = options_.sorted.has_value();
  // Points may be left out of LAS, since they are flagged as withheld.
  if (std::ranges::none_of(points.headers, is_las)) how_.count = points.records;
  if (points.stream != nullptr) source_ = points.stream->lattice();
  if (points.heights_on_lattice) how_.lattice = source_;
  if (format_.wants_wkt) how_.crs_wkt = wkt_of_code(how_.crs);
  const int dimension = points.dimension;
  if (format_.holds_attributes) {
    how_.attributes = chosen_beside_coordinates(points.attributes, wanted_attributes(), dimension);
  } else if (further_axes(dimension) > 0) {
    throw InvalidArgument(fmt::format("{} holds no coordinates beyond z, and {} is {}",
                                      format_.title, path_, format_.title),
                          {.file = path_});
  }
  check_attributes(points);
  if (format_.has_versions) {
    how_.las = las_metadata_of(points.headers);
    how_.keeps_crs_records = is_crs_of_all(points.headers, points.crs);
    how_.version = options_.las_version.empty() ? las_version_for(points, how_.las != nullptr)
                                                : options_.las_version;
  }
  lost_ = lost_fields(points.offered, points.headers, format_, how_);
  rounds_ = !options_.scale.empty() || !options_.offset.empty() ||
            (format_.needs_lattice && !how_.lattice && !options_.exact);
  check_overwriting(points);
  if (!rounds_) how_.extent = points.extent;
  if (!rounds_ || points.extent) open(points.extent.value_or(Box<3>{}));
}

/// `extent` has some of the points, in output coordinates.
void PointFile::open(const Box<3>& extent) {
  if (rounds_) {
    rounding_.emplace(path_ == "-" ? "standard output" : path_,
                      chosen_lattice({options_.scale, options_.offset}, how_.lattice, extent),
                      source_, extent);
    how_.lattice = rounding_->target();
  }
  writer_ = open_point_writer(files_, path_, how_);
}

void PointFile::append(PointBlock& block) {
  if (block.size() == 0) return;
  place(block);
  writer_->write(block.points, block.attributes);
  written_ += block.size();
}

void PointFile::place(PointBlock& block) {
  if (block.size() == 0) return;
  if (!writer_) open(world_box(block));
  if (rounding_) {
    rounding_->round(block.points, block.index);
  } else if (source_ && !how_.lattice) {
    for (LatticePoint& point : block.points) {
      point = LatticePoint(in_world(source_, point).numbers());
    }
  }
}

Box<3> PointFile::placed(const Box<3>& world) const {
  return how_.lattice ? integers_of(*how_.lattice, world) : world;
}

void PointFile::append_regions(std::span<const PointRegion> regions) {
  if (!writer_) open({});
  writer_->set_regions(regions);
}

void PointFile::append_placed(const PointsView& points) {
  writer_->write(points.points, points.attributes);
  written_ += points.size();
}

Box<3> PointFile::world_box(const PointBlock& block) const {
  Box<3> box;
  for (const LatticePoint& point : block.points) box.expand(in_world(source_, point));
  return box;
}

PointConversion PointFile::complete(std::function<void(std::uint64_t points)> finishing) {
  if (!writer_) open({});
  finishing_ = std::move(finishing);
  writer_->finish();
  writer_.reset();
  begun_ = false;
  finished_ = true;
  PointConversion done;
  done.written = written_;
  if (rounding_) {
    done.rounded = true;
    done.scale = rounding_->target().scale;
    done.offset = rounding_->target().offset;
    done.farthest = rounding_->farthest();
  }
  done.adds_heights = adds_heights_;
  done.lost = lost_;
  return done;
}

void PointFile::begin(const PointsHeader& header) {
  if (options_.sorted) throw InvalidArgument("a file is sorted by convert() only");
  RunPoints points;
  points.has_heights = header.coordinates != 2;
  points.extent = checked_box(header);
  points.crs = header.crs;
  source_ = checked_lattice(header.lattice);
  points.heights_on_lattice = source_ && header.lattice->has_z;
  told_ = checked_attributes(header.attributes);
  points.attributes = told_;
  points.offered = told_;
  start(points, {.at_once = threads_,
                 .run = [threads = threads_](std::size_t count, const WorkSharing::Body& body) {
                   with_threads(threads, [&] { share_out(count, body); });
                 }});
}

void PointFile::write(std::span<const spillway::Point<3>> points,
                      const AttributeColumns& attributes) {
  if (!begun_) throw InvalidArgument("points of a file come between begin and finish");
  for (const spillway::Point<3>& point : points) {
    if (std::ranges::all_of(point, [](double x) { return std::isfinite(x); })) continue;
    throw InvalidArgument(
        fmt::format("a point has a coordinate that is not finite: ({})", fmt::join(point, ", ")));
  }
  check_columns(attributes, told_, points.size(), "points");
  PointBlock block;
  block.attributes = records_of(attributes, how_.attributes, 0, points.size());
  block.points = points_without_lattice(points);
  const int axes = how_.coordinates == 3 && how_.lattice ? 3 : 2;
  for (std::size_t i = 0; source_ && i < block.size(); ++i) {
    for (int axis = 0; axis < axes; ++axis) {
      block.points[i][axis] = integer_on(*source_, axis, points[i][axis], "point", written_ + i);
    }
  }
  block.index.resize(points.size());
  std::iota(block.index.begin(), block.index.end(), written_);
  append(block);
}

void PointFile::finish() {
  if (!begun_) throw InvalidArgument("points of a file come between begin and finish");
  complete();
}

}  // namespace spillway::stream

namespace spillway {

std::unique_ptr<PointSink> create_points(const std::string& path, const PointFileOptions& options,
                                         const Context& context) {
  return std::make_unique<stream::PointFile>(path, options, context);
}

}  // namespace spillway

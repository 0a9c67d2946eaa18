#include "stream/library/points/program_points.h"

#include <algorithm>
#include <utility>

#include "formats/points/attributes/further_coordinates.h"
#include "src/error.h"
#include "src/geometry/lattice_check.h"
#include "stream/library/given_crs.h"
#include "stream/library/points/attribute_records.h"
#include "stream/library/points/public_points.h"

namespace spillway::stream {

ProgramPoints::ProgramPoints(PointSource& source, int dimension)
    : source_(source),
      header_(source.header()),
      told_(checked_attributes(header_.attributes)),
      dimension_(dimension),
      lattice_(checked_lattice(header_.lattice)),
      world_extent_(checked_box(header_)),
      extent_(world_extent_) {
  if (!lattice_) return;
  heights_on_lattice_ = header_.lattice->has_z;
  if (dimension > kOwnAxes || !lattice_->isotropic(std::max(1, dimension)) ||
      (dimension == 3 && !heights_on_lattice_)) {
    lattice_.reset();
  } else if (extent_) {
    extent_ = nearest_integers(*lattice_, *world_extent_);
  }
}

void refuse_taken_points(bool is_taken) {
  if (is_taken) throw InvalidArgument("the points have been read: open them again");
}

void ProgramPoints::settle_crs(CrsNeed need) {
  if (need == CrsNeed::kAll) static_cast<void>(checked_crs(header_.crs));
}

RunPoints ProgramPoints::begin(RunWatch& /*watch*/, bool /*index*/) {
  for (int axis = kOwnAxes; axis < dimension_; ++axis) check_coordinate(axis);
  attributes_ = with_further_coordinates(told_, choice(), dimension_);
  return {.stream = this,
          .dimension = further_axes(dimension_) > 0 ? dimension_ : 0,
          .has_heights = header_.coordinates == 3,
          .heights_on_lattice = heights_on_lattice_,
          .attributes = attributes_,
          .offered = told_,
          .extent = world_extent_,
          .crs = header_.crs,
          .name = "the points"};
}

/// Columns of a program are taken as they are.
void ProgramPoints::check_coordinate(int axis) const {
  const AttributeField* const field = find_coordinate(told_, axis);
  const Attribute is{.name = field != nullptr ? field->attribute.name : coordinate_name(axis)};
  if (field != nullptr && field->attribute.type == is.type && field->attribute.scale == 1 &&
      field->attribute.offset == 0) {
    return;
  }
  throw InvalidArgument(fmt::format(
      "coordinate {} of points of {} dimensions is an attribute of one float64, without "
      "a scale, called {}, but the header tells of none",
      axis + 1, dimension_, is.name));
}

bool ProgramPoints::fetch(SourcePiece& piece) {
  PointBlock& block = piece.raw.decoded;
  block.clear();
  block_.points.clear();
  if (!source_.read(block_)) return false;
  block.points.reserve(block_.points.size());
  for (const spillway::Point<3>& point : block_.points) block.points.emplace_back(point);
  if (!attributes_.empty()) {
    check_columns(block_.attributes, told_, block.size(), "points");
    block.attributes = records_of(block_.attributes, attributes_, 0, block.size());
  }
  piece.raw.first = read_;
  read_ += block.size();
  return true;
}

LatticePoint ProgramPoints::placed(const spillway::Point<3>& point, std::uint64_t number) const {
  LatticePoint placed(finite_point<3>(point, number));
  if (!lattice_) return placed;
  const int axes = heights_on_lattice_ && header_.coordinates == 3 ? 3 : 2;
  for (int axis = 0; axis < axes; ++axis) {
    placed[axis] = integer_on(*lattice_, axis, point[axis], "point", number);
  }
  return placed;
}

void ProgramPoints::decode(SourcePiece& piece, PointBlock& block) {
  std::swap(piece.raw.decoded, block);
  block.index.resize(block.size());
  for (std::size_t i = 0; i < block.size(); ++i) {
    const std::uint64_t number = piece.raw.first + i;
    block.points[i] = placed(block.points[i].numbers(), number);
    block.index[i] = number;
  }
  const CoordinateCheck check(told_, dimension_);
  if (const auto bad = check.first_bad(block.attributes, block.record_size())) {
    throw InvalidArgument(fmt::format("point {} has {}", block.index[*bad],
                                      check.text(&block.attributes[*bad * block.record_size()])));
  }
}

std::optional<double> ProgramPoints::fraction_read() const {
  if (!header_.count || *header_.count == 0) return std::nullopt;
  return std::min(1.0, static_cast<double>(read_) / static_cast<double>(*header_.count));
}

}  // namespace spillway::stream

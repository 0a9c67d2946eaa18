#include "stream/source/source_coordinates.h"

#include <fmt/format.h>

#include <algorithm>

#include "formats/points/attributes/further_coordinates.h"
#include "formats/points/point_formats.h"
#include "src/geometry/lattice_check.h"

namespace spillway::stream {
namespace {

/// Integers up to `largest`, their signs aside.
Box<3> integers_up_to(double largest) {
  return {{-largest, -largest, -largest}, {largest, largest, largest}};
}

/// The integers that a source with a lattice may give, by its format; its extent may be false.
Box<3> possible_integers(const PointHeader& header) {
  const PointFormat* const format = find_point_format(header.format);
  return integers_up_to(format != nullptr ? format->largest_integer : 0x1p31);
}

Box<3> mapped(const Box<3>& integers, const LatticeMap& map) {
  Box<3> box;
  for (const Point<3>& corner : {integers.lo, integers.hi}) {
    box.expand(Point<3>{map.map(0, corner[0]), map.map(1, corner[1]), map.map(2, corner[2])});
  }
  return box;
}

}  // namespace

SourceCoordinates::SourceCoordinates(const SourceFacts& facts, int dimension,
                                     const PointFilter& filter,
                                     const std::function<void(std::string_view)>& detail)
    : facts_(facts),
      is_triangulated_(dimension > 0),
      is_on_lattice_(dimension <= kOwnAxes),
      dimension_(dimension > 0 ? std::min(dimension, kOwnAxes) : 2),
      filter_(filter),
      inputs_(facts.inputs.size()) {
  if (filter.bounds) filter_.bounds = filter.loose_box();
  check_own_lattices();
  find_lattice(detail);
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    inputs_[i].as_it_is =
        !header_of(i).lattice || (lattice_ && heights_on_lattice_ && inputs_[i].map.is_identity());
  }
}

/// By the extent that a header tells of the points that may be kept. Where only the points can show
/// whether they are apart, each block is looked at when it comes.
void SourceCoordinates::check_own_lattices() {
  const bool extent_tells = filter_.every == 1 && !filter_.needs_attributes();
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const PointHeader& header = header_of(i);
    if (!header.lattice) continue;
    const Box<3> possible = possible_integers(header);
    if (is_exact(*header.lattice, possible, dimension_)) continue;
    inputs_[i].exact_up_to = exact_up_to(*header.lattice, dimension_);
    if (!header.extent || !extent_tells) continue;
    const Box<3> kept =
        filter_.box() ? common_part(*header.extent, *filter_.loose_box()) : *header.extent;
    check_lattice({header.name}, *header.lattice,
                  common_part(integers_of(*header.lattice, kept), possible), dimension_);
  }
}

std::optional<CommonLattice> SourceCoordinates::common_lattice() const {
  std::vector<IntegerLattice> lattices;
  std::vector<double> largest;
  for (const SourceFacts::Input& input : facts_.inputs) {
    if (!input.header.lattice) return std::nullopt;
    lattices.push_back(*input.header.lattice);
    largest.push_back(largest_integer(input.header));
  }
  return find_common_lattice(lattices, joined_axes(), largest);
}

/// The first input whose points a common lattice does not keep apart; null if there is none.
const PointHeader* SourceCoordinates::first_not_apart(const CommonLattice& common) const {
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (common.maps[i].is_identity()) continue;  // as its own lattice does
    const Box<3> integers = mapped(integers_up_to(largest_integer(header_of(i))), common.maps[i]);
    if (!is_exact(common.lattice, integers, dimension_)) return &header_of(i);
  }
  return nullptr;
}

/// Coordinates beyond z are on no lattice, and all axes are to have one scale.
void SourceCoordinates::find_lattice(const std::function<void(std::string_view)>& detail) {
  if (!is_on_lattice_) return;
  const auto common = common_lattice();
  if (const PointHeader* mixed = common ? first_not_apart(*common) : nullptr) {
    detail(
        fmt::format("{}: the common lattice of all inputs, of step {}, does not keep its points "
                    "apart, so points come in output coordinates",
                    mixed->name, common->lattice.scale[0]));
    return;
  }
  if (common) {
    lattice_ = common->lattice;
    heights_on_lattice_ = common->heights;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      Input& input = inputs_[i];
      input.map = common->maps[i];
      while (
          input.exact_up_to.value_or(0) >= 1 &&
          !is_exact(*lattice_, mapped(integers_up_to(*input.exact_up_to), input.map), dimension_)) {
        *input.exact_up_to /= 2;
      }
    }
  }
  if (std::ranges::any_of(facts_.inputs, [](const SourceFacts::Input& input) {
        return input.header.lattice.has_value();
      })) {
    explain_lattice(detail);
  }
}

/// Says on which lattice the points come, if it is not that of the only input; without one, which
/// input is the first that does not fit to the first of all.
void SourceCoordinates::explain_lattice(const std::function<void(std::string_view)>& detail) const {
  const PointHeader& first = header_of(0);
  if (lattice_) {
    if (inputs_.size() == 1 && lattice_ == first.lattice) return;
    detail(fmt::format("points come on a lattice of step {}, heights {}", lattice_->scale[0],
                       heights_on_lattice_ ? "on it, too" : "as they are"));
    return;
  }
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const PointHeader& header = header_of(i);
    const bool fits =
        first.lattice && header.lattice &&
        find_common_lattice(std::vector{*first.lattice, *header.lattice}, joined_axes(),
                            std::vector{largest_integer(first), largest_integer(header)});
    if (fits) continue;
    detail(fmt::format(
        "{}: {}, so points come in output coordinates", header.name,
        i == 0 ? "its axes have no common scale" : "not on one lattice with the first input"));
    return;
  }
  detail("no lattice has all inputs, so points come in output coordinates");
}

Box<3> SourceCoordinates::of_world(const Box<3>& world) const {
  if (!lattice_) return world;
  Box<3> box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = (world.lo[k] - lattice_->offset[k]) / lattice_->scale[k];
    box.hi[k] = (world.hi[k] - lattice_->offset[k]) / lattice_->scale[k];
  }
  return box;
}

Box<3> SourceCoordinates::told_extent(std::size_t input) const {
  return told_box(input, *header_of(input).extent);
}

Box<3> SourceCoordinates::told_box(std::size_t input, const Box<3>& world) const {
  const PointHeader& header = header_of(input);
  const Box<3> told = header.lattice ? nearest_integers(*header.lattice, world) : world;
  Box<3> box;
  for (const Point<3>& corner : {told.lo, told.hi}) {
    const LatticePoint point(corner);
    box.expand(inputs_[input].as_it_is ? point : placed(input, point));
  }
  return box;
}

LatticePoint SourceCoordinates::placed(std::size_t input, const LatticePoint& point) const {
  const IntegerLattice& own = *header_of(input).lattice;
  if (!lattice_) return LatticePoint(own.to_world(point).numbers());
  const LatticeMap& map = inputs_[input].map;
  return {map.map(0, point[0]), map.map(1, point[1]),
          heights_on_lattice_ ? map.map(2, point[2]) : own.to_world(2, point[2])};
}

void SourceCoordinates::check_points(std::size_t input, const AttributeLayout& attributes,
                                     PointBlock block) const {
  const PointHeader& header = header_of(input);
  if (filter_.active()) {
    PointCounts not_counted;
    apply_filter(filter_, header.lattice, attributes, block, not_counted);
  }
  const Box<3> box = box_around(block.points);
  check_lattice({header.name}, *header.lattice, box, dimension_);
  if (lattice_) {
    check_lattice({header.name}, *lattice_, mapped(box, inputs_[input].map), dimension_);
  }
}

void SourceCoordinates::bring(std::size_t input, const AttributeLayout& attributes,
                              PointBlock& block) const {
  const std::optional<double>& exact = inputs_[input].exact_up_to;
  if (exact && any_beyond(block.points, *exact)) check_points(input, attributes, block);
  if (inputs_[input].as_it_is) return;
  for (LatticePoint& point : block.points) point = placed(input, point);
}

}  // namespace spillway::stream

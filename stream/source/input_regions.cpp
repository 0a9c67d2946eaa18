#include "stream/source/input_regions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "src/error.h"
#include "stream/source/false_header.h"

namespace spillway::stream {
namespace {

/// Headers may be off by so much in their coordinates, by rounding, besides a step of a lattice.
constexpr double kRelativeMargin = 1e-12;

/// Where a program has not filled in the extent, there are zeros in its place.
bool is_filled_in(const Box<3>& extent) {
  const Point<3> zero{};
  return extent.lo != zero || extent.hi != zero;
}

bool tells_where(const PointHeader& header) {
  if (!header.regions.empty() || header.count == 0) return true;
  return header.count && extent_told_by(header);
}

/// Whether the corners of a box in output coordinates are points of a lattice to the last bit.
bool is_on(const IntegerLattice& lattice, const Box<3>& world, int dimension) {
  for (int k = 0; k < dimension; ++k) {
    const auto lo = lattice.to_integer(k, world.lo[k]);
    const auto hi = lattice.to_integer(k, world.hi[k]);
    if (!lo || !hi) return false;
    if (!lattice.keeps_apart(k, std::min(*lo, *hi), std::max(*lo, *hi))) return false;
  }
  return true;
}

}  // namespace

std::optional<Box<3>> extent_told_by(const PointHeader& header) {
  if (!header.extent || (header.count != 1 && !is_filled_in(*header.extent))) return std::nullopt;
  return header.extent;
}

Box<3> with_a_step_more(const Box<3>& told, const std::optional<IntegerLattice>& lattice) {
  Box<3> wide = told;
  for (int k = 0; k < 3; ++k) {
    const double most = std::max(std::abs(told.lo[k]), std::abs(told.hi[k]));
    const double margin = (lattice ? std::abs(lattice->scale[k]) : 0) + most * kRelativeMargin;
    wide.lo[k] -= margin;
    wide.hi[k] += margin;
  }
  return wide;
}

InputRegions::InputRegions(const SourceFacts& facts, const SourceCoordinates& coordinates,
                           const PointFilter& filter)
    : facts_(facts), coordinates_(coordinates) {
  if (!std::ranges::all_of(facts.inputs, tells_where,
                           [](const SourceFacts::Input& input) { return input.header; })) {
    return;
  }
  const std::optional<Box<3>> bounds = filter.loose_box();
  for (std::size_t i = 0; i < facts.inputs.size(); ++i) {
    const PointHeader& header = facts.inputs[i].header;
    first_.push_back(regions_.size());
    // Pieces of a file that are a region each, as nodes of COPC, can be read in any order.
    const bool in_pieces =
        !header.regions.empty() && facts.inputs[i].pieces == header.regions.size();
    const auto add = [&](const Box<3>& told, std::uint64_t count) {
      const std::uint64_t piece = regions_.size() - first_.back();
      if (in_pieces) {
        turns_.push_back({i, piece});
      } else if (piece == 0) {
        turns_.push_back({i, std::nullopt});
      }
      InputRegion region{turns_.size() - 1, {}, count / filter.every};
      const Box<3> kept = bounds ? common_part(told, *bounds) : told;
      if (count > 0 && !kept.empty()) {
        region.box = common_part(box_of(i, told), wide_box_of(i, kept));
      }
      regions_.push_back(region);
    };
    for (const PointRegion& region : header.regions) add(region.box, region.count);
    if (header.regions.empty()) add(header.extent.value_or(Box<3>{}), *header.count);
  }
}

/// What a header tells, in the coordinates of the source. Where it is not exact, it is wide; but a
/// step more would make each cell of a sorted stream wait for its neighbours.
Box<3> InputRegions::box_of(std::size_t input, const Box<3>& told) const {
  const PointHeader& header = facts_.inputs[input].header;
  const bool is_exact = header.regions_are_exact &&
                        (!header.lattice || is_on(*header.lattice, told, coordinates_.dimension()));
  return is_exact ? coordinates_.told_box(input, told) : wide_box_of(input, told);
}

/// with_a_step_more(), in the coordinates of the source.
Box<3> InputRegions::wide_box_of(std::size_t input, const Box<3>& told) const {
  const Box<3> box =
      coordinates_.of_world(with_a_step_more(told, facts_.inputs[input].header.lattice));
  Box<3> ordered;  // scales may be negative
  ordered.expand(box.lo);
  ordered.expand(box.hi);
  return ordered;
}

/// Heights are not looked at in the plane, and where a source has none.
void InputRegions::check(const PointBlock& block, std::size_t region) const {
  const Box<3>& box = regions_[region].box;
  const int axes = coordinates_.dimension();
  Box<3> reached;
  for (const LatticePoint& point : block.points) reached.expand(point);
  bool inside = true;
  for (int k = 0; k < axes; ++k) {
    inside = inside && reached.lo[k] >= box.lo[k] && reached.hi[k] <= box.hi[k];
  }
  if (inside || block.points.empty()) return;
  for (std::size_t i = 0; i < block.points.size(); ++i) {
    for (int k = 0; k < axes; ++k) {
      const double x = block.points[i][k];
      if (!(x >= box.lo[k] && x <= box.hi[k])) refuse(block, i, region);
    }
  }
}

void InputRegions::refuse(const PointBlock& block, std::size_t point, std::size_t region) const {
  const std::size_t input = turns_[regions_[region].unit].input;
  const PointHeader& header = facts_.inputs[input].header;
  const bool is_whole = header.regions.empty();
  const Box<3> told =
      is_whole ? header.extent.value_or(Box<3>{}) : header.regions[region - first_[input]].box;
  const auto place = in_world(coordinates_.lattice(), block.points[point]).numbers();
  const std::uint64_t number = block.index[point];
  const BadInput error(
      header.name,
      fmt::format("point {} at ({:.15g}) lies outside of the box that the {} tells", number,
                  fmt::join(place.begin(), place.begin() + coordinates_.dimension(), ", "),
                  is_whole ? "header" : "file's division into parts"),
      {PlaceUnit::kRecord, number}, Remedy::kDistrustHeaders);
  const auto corner = [this](const Point<3>& of_box) {
    return fmt::format("({:.15g})",
                       fmt::join(of_box.begin(), of_box.begin() + coordinates_.dimension(), ", "));
  };
  throw FalseHeader(
      error, fmt::format("{}, from {} to {}", error.what(), corner(told.lo), corner(told.hi)));
}

}  // namespace spillway::stream

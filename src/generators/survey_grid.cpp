#include "src/generators/survey_grid.h"

#include <algorithm>

#include "src/generators/random.h"

namespace spillway::generators {
namespace {

/// How far a line strays from its place among even ones, in sides of a mean tile.
constexpr double kMostStray = 0.3;

// Sequences of random numbers of one seed.
constexpr std::uint64_t kLinesOfX = 11;
constexpr std::uint64_t kLinesOfY = 12;
constexpr std::uint64_t kSides = 13;

}  // namespace

SurveyGrid::SurveyGrid(const Box<3>& extent, const SurveyGridShape& shape, std::uint64_t seed)
    : x_(make_axis(extent.lo[0], extent.hi[0], shape.columns, shape.overlap,
                   mix_bits(seed) + kLinesOfX)),
      y_(make_axis(extent.lo[1], extent.hi[1], shape.rows, shape.overlap,
                   mix_bits(seed) + kLinesOfY)),
      seed_(mix_bits(seed) + kSides) {}

SurveyGrid::Axis SurveyGrid::make_axis(double lo, double hi, std::size_t tiles, double overlap,
                                       std::uint64_t seed) {
  const double side = (hi - lo) / static_cast<double>(tiles);
  Axis axis{.lines = {}, .half_strip = side * overlap / 2};
  axis.lines.reserve(tiles - 1);
  for (std::size_t i = 1; i < tiles; ++i) {
    const double stray = kMostStray * (2 * Random(seed, i).uniform() - 1);
    axis.lines.push_back(lo + side * (static_cast<double>(i) + stray));
  }
  return axis;
}

/// In the strip of a line a point is `beyond` it or not; elsewhere that changes nothing.
std::size_t SurveyGrid::place_on(const Axis& axis, double coordinate, bool beyond) {
  const double moved = coordinate + (beyond ? axis.half_strip : -axis.half_strip);
  return static_cast<std::size_t>(std::ranges::upper_bound(axis.lines, moved) - axis.lines.begin());
}

std::size_t SurveyGrid::tile_of(const Point<3>& point, std::uint64_t index) const {
  const std::uint64_t bits = Random(seed_, index).bits();
  const std::size_t column = place_on(x_, point[0], (bits & 1U) != 0);
  const std::size_t row = place_on(y_, point[1], (bits & 2U) != 0);
  return row * (x_.lines.size() + 1) + column;
}

}  // namespace spillway::generators

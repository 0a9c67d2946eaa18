#include "stream/library/tiling/square_tiling.h"

#include <fmt/format.h>

#include <cmath>

#include "src/error.h"

namespace spillway::stream {
namespace {

constexpr double kMostTiles = 1e6;

/// A length that is a whole number of pixels but for rounding is taken for that.
constexpr double kRoundingShare = 1e-9;
/// Likewise the edge of a pixel, as a part of the pixel.
constexpr double kRoundingOfEdge = 1e-6;

/// Coordinates are counted in pixels up to here.
constexpr double kMostSteps = 1e15;

/// Rounded down.
std::int64_t quotient(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

/// Pixels from an edge on to the ends of squares.
std::vector<std::uint32_t> cuts(std::int64_t first, std::int64_t square, std::uint32_t count) {
  std::vector<std::uint32_t> ends = {0};
  for (std::int64_t end = first; end < count; end += square) {
    ends.push_back(static_cast<std::uint32_t>(end));
  }
  ends.push_back(count);
  return ends;
}

}  // namespace

/// Lengths in pixels.
struct SquareTiling::Steps {
  std::int64_t square;
  std::int64_t west;
  std::int64_t north;
};

SquareTiling::Steps SquareTiling::steps_of(const PixelGrid& raster) const {
  const double pixel = raster.resolution;
  const double square = std::round(names_.side() / pixel);
  if (square < 1 || square > kMostSteps ||
      std::abs(square * pixel - names_.side()) > kRoundingShare * names_.side()) {
    throw InvalidArgument(
        fmt::format("tiles of side {} are no whole number of pixels of {}: choose another side",
                    names_.side(), pixel));
  }
  const auto steps_to = [&](double edge) {
    const double steps = std::round(edge / pixel);
    if (std::abs(steps) > kMostSteps || std::abs(steps - edge / pixel) > kRoundingOfEdge) {
      throw InvalidArgument(fmt::format(
          "the raster begins at {:.15g}, {:.15g}, and tiles need edges of pixels at multiples of "
          "their side, {}",
          raster.west, raster.north, pixel));
    }
    return static_cast<std::int64_t>(steps);
  };
  return {static_cast<std::int64_t>(square), steps_to(raster.west), steps_to(raster.north)};
}

std::vector<RasterTile> SquareTiling::tiles(const PixelGrid& raster) const {
  const auto [square, west, north] = steps_of(raster);
  const double count = (static_cast<double>(raster.columns) / static_cast<double>(square) + 1) *
                       (static_cast<double>(raster.rows) / static_cast<double>(square) + 1);
  if (count > kMostTiles) {
    throw InvalidArgument(
        fmt::format("a raster of {} x {} pixels has more than a million tiles of side {}: choose a "
                    "larger one",
                    raster.columns, raster.rows, names_.side()));
  }
  const std::vector<std::uint32_t> columns =
      cuts((quotient(west, square) + 1) * square - west, square, raster.columns);
  const std::vector<std::uint32_t> rows =
      cuts(north - quotient(north - 1, square) * square, square, raster.rows);
  std::vector<RasterTile> tiles;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    for (std::size_t c = 1; c < columns.size(); ++c) {
      tiles.push_back({{rows[r - 1], rows[r], columns[c - 1], columns[c]},
                       names_.path({.row = quotient(north - rows[r - 1] - 1, square),
                                    .column = quotient(west + columns[c - 1], square)})});
    }
  }
  return tiles;
}

}  // namespace spillway::stream

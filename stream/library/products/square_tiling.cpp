#include "stream/library/products/square_tiling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <string_view>
#include <system_error>
#include <utility>

#include "src/error.h"

namespace spillway::stream {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kX = "{x}";
constexpr std::string_view kY = "{y}";

constexpr double kMostTiles = 1e6;

/// A length that is a whole number of pixels but for rounding is taken for that.
constexpr double kRoundingShare = 1e-9;
/// Likewise the edge of a pixel, as a part of the pixel.
constexpr double kRoundingOfEdge = 1e-6;

/// Coordinates are counted in pixels up to here.
constexpr double kMostSteps = 1e15;

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  const std::size_t at = text.find(what);
  if (at != std::string::npos) text.replace(at, what.size(), by);
  return text;
}

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

SquareTiling::SquareTiling(std::string pattern, double side)
    : pattern_(std::move(pattern)), side_(side) {
  if (!(side_ > 0) || !std::isfinite(side_)) {
    throw InvalidArgument(fmt::format("tiles have a side above 0, not of {}", side_));
  }
  const std::string name = fs::path(pattern_).filename();
  const auto has_one = [&name](std::string_view what) {
    const std::size_t at = name.find(what);
    return at != std::string::npos && name.find(what, at + 1) == std::string::npos;
  };
  if (!has_one(kX) || !has_one(kY)) {
    throw InvalidArgument(
        fmt::format("{}: files of tiles need {{x}} and {{y}} once in their name, which become the "
                    "corner in the south-west, as in dtm_{{x}}_{{y}}.tif",
                    pattern_),
        {.file = pattern_});
  }
}

SquareTiling::Steps SquareTiling::steps_of(const PixelGrid& raster) const {
  const double pixel = raster.resolution;
  const double square = std::round(side_ / pixel);
  if (square < 1 || std::abs(square * pixel - side_) > kRoundingShare * side_) {
    throw InvalidArgument(fmt::format(
        "tiles of side {} are no whole number of pixels of {}: choose another side", side_, pixel));
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
                    raster.columns, raster.rows, side_));
  }
  const std::vector<std::uint32_t> columns =
      cuts((quotient(west, square) + 1) * square - west, square, raster.columns);
  const std::vector<std::uint32_t> rows =
      cuts(north - quotient(north - 1, square) * square, square, raster.rows);
  std::vector<RasterTile> tiles;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    for (std::size_t c = 1; c < columns.size(); ++c) {
      tiles.push_back({{rows[r - 1], rows[r], columns[c - 1], columns[c]},
                       path_of(quotient(west + columns[c - 1], square),
                               quotient(north - rows[r - 1] - 1, square))});
    }
  }
  return tiles;
}

/// Of a square, which is counted from the origin to the east and to the north.
std::string SquareTiling::path_of(std::int64_t column, std::int64_t row) const {
  const auto corner = [this](std::int64_t number) {
    return fmt::format("{:.12g}", static_cast<double>(number) * side_ + 0.0);
  };
  const fs::path path(pattern_);
  return path.parent_path() /
         replaced(replaced(path.filename(), kX, corner(column)), kY, corner(row));
}

std::vector<std::string> SquareTiling::others_than(std::vector<std::string> paths) const {
  constexpr const char* kNumber = "-?[0-9]+(\\.[0-9]+)?(e[+-]?[0-9]+)?";
  const fs::path path(pattern_);
  const std::regex special(R"([-[\]{}()*+?.,\^$|#\s])");
  const auto literally = [&](std::string_view text) {
    return std::regex_replace(std::string(text), special, R"(\$&)");
  };
  const std::string name = literally(path.filename().string());
  const std::regex names(replaced(replaced(name, literally(kX), kNumber), literally(kY), kNumber));
  std::ranges::sort(paths);
  std::vector<std::string> others;
  std::error_code ignored;
  const fs::path folder = path.parent_path();
  for (fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, ignored), end;
       !ignored && entry != end; entry.increment(ignored)) {
    const std::string found = entry->path().filename();
    if (std::regex_match(found, names) &&
        !std::ranges::binary_search(paths, (folder / found).string())) {
      others.push_back(folder / found);
    }
  }
  std::ranges::sort(others);
  return others;
}

}  // namespace spillway::stream

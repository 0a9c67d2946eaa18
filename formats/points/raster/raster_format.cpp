#include "formats/points/raster/raster_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <utility>

#include "formats/points/raster/raster_points.h"

namespace spillway::formats {
namespace {

using namespace std::string_view_literals;

/// How files begin, in capital letters: GeoTIFF, Arc/Info grid, Surfer grid, VRT, ERDAS Imagine. Of
/// other formats of GDAL the user names that they are rasters.
constexpr std::array kBeginnings = {"II*\0"sv,  "MM\0*"sv,       "II+\0"sv,          "MM\0+"sv,
                                    "NCOLS "sv, "NCOLS\t"sv,     "DSAA"sv,           "DSBB"sv,
                                    "DSRB"sv,   "<VRTDATASET"sv, "EHFA_HEADER_TAG"sv};

bool begins_as_raster(std::string_view first_bytes) {
  constexpr std::size_t kLongest = 16;
  std::string begin(first_bytes.substr(0, kLongest));
  std::ranges::transform(begin, begin.begin(), [](unsigned char c) { return std::toupper(c); });
  return std::ranges::any_of(kBeginnings,
                             [&](std::string_view text) { return begin.starts_with(text); });
}

}  // namespace

constinit const PointFormat kRasterPoints = {
    .name = "raster",
    .title = "a raster",
    .extensions = {},  // a folder of points may hold rasters that were made of them
    .recognises = begins_as_raster,
    .open_reader =
        [](PointInput input, const PointReaderOptions& /*options*/) {
          return open_raster_points(std::move(input.source), input.path);
        },
};

}  // namespace spillway::formats

#include "tools/dem_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway {
namespace {

double parse_resolution(const std::string& text) {
  double resolution = 0;
  constexpr double kLargest = 1e100;
  const bool number = CLI::detail::lexical_cast(text, resolution);
  if (!number || !(resolution >= 1 / kLargest && resolution <= kLargest)) {
    throw UsageError(fmt::format("--resolution: \"{}\" is no length; give a number above 0", text));
  }
  return resolution;
}

float parse_nodata(const std::string& text) {
  double value = 0;
  const bool number = CLI::detail::lexical_cast(text, value);
  if (!number || std::isinf(static_cast<float>(value))) {
    throw UsageError(
        fmt::format("--nodata: \"{}\" is no value of a pixel; give a number or nan", text));
  }
  return static_cast<float>(value);
}

std::vector<DemProduct> parse_products(const std::string& text) {
  const std::vector<std::string>& names = dem_product_names();
  std::vector<DemProduct> products;
  for (const std::string& name : CLI::detail::split(text, ',')) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      throw UsageError(
          fmt::format("--product: \"{}\" is none; give {}, several separated by commas", name,
                      fmt::join(names, ", ")));
    }
    products.push_back(static_cast<DemProduct>(found - names.begin()));
    if (std::count(products.begin(), products.end(), products.back()) > 1) {
      throw UsageError(fmt::format("--product: {} is there twice", name));
    }
  }
  return products;
}

Box<2> parse_raster_bounds(const std::string& text) {
  const Box<3> box = parse_bounds(text);
  if (std::isfinite(box.lo[2]) || !(box.lo[0] < box.hi[0] && box.lo[1] < box.hi[1])) {
    throw UsageError(fmt::format("--bounds: \"{}\" is no area; give xmin,ymin,xmax,ymax", text));
  }
  return {{box.lo[0], box.lo[1]}, {box.hi[0], box.hi[1]}};
}

}  // namespace

void add_dem_options(CLI::App& app, DemCommandOptions& options) {
  app.add_option("-o,--output", options.output, "GeoTIFF file")->required()->type_name("FILE");
  add_terrain_options(app, options);
  // These are filters of points there; here they say what the raster is like.
  app.remove_option(app.get_option("--bounds"));
  app.remove_option(app.get_option("--resolution"));
  const std::string group = "Raster";
  app.add_option("--resolution", options.resolution, "Side of a pixel, in units of x and y")
      ->type_name("R")
      ->group(group);
  app.add_option("--bounds", options.bounds, "Cover xmin,ymin,xmax,ymax [all points]")
      ->type_name("BOX")
      ->group(group);
  app.add_flag("--force-size", options.force_size,
               "Cover all points, though some may lie far away and pixels be very many")
      ->group(group);
  app.add_flag("--align", options.align, "Put edges of pixels on multiples of R")->group(group);
  app.add_option("--like", options.like, "Put pixels where this raster has them")
      ->type_name("FILE")
      ->group(group);
  app.add_option("--product", options.products,
                 "height, slope, aspect, hillshade, density; several, with commas, become bands")
      ->type_name("LIST")
      ->capture_default_str()
      ->group(group);
  options.azimuth_option =
      app.add_option("--azimuth", options.light.azimuth, "Where a hillshade's light comes from")
          ->type_name("DEGREES")
          ->check(CLI::Range(0.0, 360.0).description(""))
          ->capture_default_str()
          ->group(group);
  options.altitude_option =
      app.add_option("--altitude", options.light.altitude, "Its height above the horizon")
          ->type_name("DEGREES")
          ->check(CLI::Range(0.0, 90.0).description(""))
          ->capture_default_str()
          ->group(group);
  app.add_option("--nodata", options.nodata, "Value of pixels without data")
      ->type_name("V")
      ->capture_default_str()
      ->group(group);
  add_choice(app, "--compress", options.compression, {"deflate", "zstd", "none"},
             "Compression of the file")
      ->group(group);
  app.add_flag("--cog", options.cloud_optimized, "Make it cloud optimized, with overviews")
      ->group(group);
  add_report_options(app, options.report);
}

DemOptions dem_options(const DemCommandOptions& options, RasterGrid& like) {
  DemOptions dem;
  if (options.force_size && !options.bounds.empty()) {
    throw UsageError("--bounds tells what to cover: leave --force-size away");
  }
  if (options.like.empty()) {
    if (options.resolution.empty()) {
      throw UsageError("--resolution R, the side of a pixel, is missing (or --like FILE)");
    }
    dem.grid.resolution = parse_resolution(options.resolution);
    if (!options.bounds.empty()) dem.grid.bounds = parse_raster_bounds(options.bounds);
    dem.grid.align = options.align;
  } else {
    if (!options.resolution.empty() || !options.bounds.empty() || options.align ||
        options.force_size) {
      throw UsageError(
          "--like tells where all pixels lie: leave --resolution, --bounds, --align and "
          "--force-size away");
    }
    like = gdal().read_raster_grid(options.like);
    dem.grid.given = like.pixels;
  }
  dem.products = parse_products(options.products);
  dem.light = options.light;
  dem.nodata = parse_nodata(options.nodata);
  return dem;
}

}  // namespace spillway

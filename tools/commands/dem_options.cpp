#include "tools/commands/dem_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "tools/commands/tile_files.h"
#include "tools/options/suggestion.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

double parse_resolution(const std::string& text) {
  constexpr double kLargest = 1e100;
  const auto resolution = parse_number(text);
  if (!resolution || !(*resolution >= 1 / kLargest && *resolution <= kLargest)) {
    throw UsageError(fmt::format("\"{}\" is not a length; give a number above 0", text));
  }
  return *resolution;
}

double parse_factor(const std::string& text) {
  const auto factor = parse_number(text);
  if (!factor || !(*factor > 0) || std::isinf(*factor)) {
    throw UsageError(fmt::format("\"{}\" is not a factor; give a number above 0", text));
  }
  return *factor;
}

float parse_nodata(const std::string& text) {
  if (text == "nan" || text == "NaN") return std::numeric_limits<float>::quiet_NaN();
  const auto value = parse_number(text);
  if (!value || std::isinf(static_cast<float>(*value))) {
    throw UsageError(fmt::format("\"{}\" is not a pixel value; give a number or nan", text));
  }
  return static_cast<float>(*value) + 0.0F;  // -0 becomes 0
}

/// Sets products and percentiles.
void parse_products(const std::string& text, DemOptions& dem) {
  if (text == kCanopy) {
    dem.products = {DemProduct::kHeight};  // of heights above the ground
    return;
  }
  std::vector<std::string> seen;
  dem.products.clear();
  std::istringstream words(text);
  for (std::string name; std::getline(words, name, ',');) {
    if (name == kCanopy) throw UsageError("chm is a raster of its own: ask for it alone");
    const std::optional<DemBand> band = dem_band_of(name);
    if (!band) {
      throw UsageError(fmt::format(
          "\"{}\" is not a product{}; give height, slope, hillshade, max, p95 (a percentile) or "
          "another one, several separated by commas",
          name, suggestion(name, plain_product_names())));
    }
    dem.products.push_back(band->product);
    if (band->product == DemProduct::kPercentile) dem.percentiles.push_back(band->percentile);
    if (std::ranges::count(seen, seen.emplace_back(name_of(*band))) > 1) {
      throw UsageError(fmt::format("{} appears twice", name));
    }
  }
}

/// Refuses options of triangles where none are needed.
void refuse_options_of_triangles(const CommandLine& app) {
  std::vector<std::string_view> names(kTriangulationOptionNames.begin(),
                                      kTriangulationOptionNames.end());
  names.emplace_back("--max-edge");
  std::erase(names, "--no-trust-headers");
  refuse_given(app, names, "on products of points alone, for which nothing is triangulated");
}

/// Refuses options that make no difference to the products.
void check_products(const DemCommandOptions& options, const std::vector<DemProduct>& products) {
  const auto any = [&](bool DemProductTraits::*trait) {
    return std::ranges::any_of(products, [trait](DemProduct one) { return traits_of(one).*trait; });
  };
  const CommandLine& app = *options.app;
  if (!any(&DemProductTraits::by_azimuth)) {
    refuse_given(app, {"--azimuth"}, "without hillshade among the products");
  }
  if (!any(&DemProductTraits::by_altitude)) {
    refuse_given(app, {"--altitude"}, "without hillshade among the products");
  }
  if (!any(&DemProductTraits::by_ground)) {
    refuse_given(app, {"--z-factor"},
                 "without slope, aspect, hillshade or curvature among the products");
  }
  if (!any(&DemProductTraits::by_gradient)) {
    refuse_given(app, {"--gradient"}, "without slope, aspect or hillshade among the products");
  }
  if (!any(&DemProductTraits::of_neighbours)) {
    refuse_given(app, {"--compute-edges"}, "without a product of a pixel's neighbours, like slope");
  }
  if (!any(&DemProductTraits::fills_voids)) {
    refuse_given(app, {"--fill-voids"}, "without min, max, mean or a percentile");
  }
  if (std::ranges::all_of(products, [](DemProduct one) { return traits_of(one).of_points; }) &&
      !options.fill_voids) {
    refuse_options_of_triangles(app);
  }
  if (products == std::vector{DemProduct::kDensity}) {
    refuse_given(app, {"--heights", "--max-edge"}, "on density, which counts vertices");
  }
  if (options.type != "byte") return;
  refuse_given(app, {"--nodata"}, "on bytes, in which 0 is no data");
  for (const DemProduct product : products) {
    if (traits_of(product).by_altitude) continue;
    throw UsageError(fmt::format(
        "--type byte is for shades, from 1 to 255: {} does not fit; leave it out, or --type",
        dem_product_names()[static_cast<std::size_t>(product)]));
  }
}

/// Which files there are to be.
void set_tiles(const DemCommandOptions& options, DemOptions& dem) {
  if (options.tiles.empty()) {
    refuse_given(*options.app, {"--vrt"}, "without --tiles, which a VRT puts together");
    refuse_pattern(options.output);
    return;
  }
  dem.vrt = options.vrt;
  const TileChoice tiles = parse_tiles(options.tiles);
  dem.tile_side = tiles.side;
  dem.tile_polygons = tiles.polygons;
  if (tiles.side == 0) {
    dem.foreign_crs = options.input.force_crs;
  } else {
    refuse_given(*options.app, {"--align"}, "with tiles that are squares, which align pixels");
  }
}

Extent parse_raster_bounds(const std::string& text) {
  const Extent box = parse_bounds(text);
  if (std::isfinite(box.low[2]) || !(box.low[0] < box.high[0] && box.low[1] < box.high[1])) {
    throw UsageError(fmt::format("\"{}\" is not an area; give xmin,ymin,xmax,ymax", text));
  }
  return box;
}

}  // namespace

std::vector<std::string> plain_product_names() {
  std::vector<std::string> names = dem_product_names();
  names.pop_back();
  return names;
}

void add_dem_options(CommandLine& app, DemCommandOptions& options) {
  app.add_option("-o,--output", options.output,
                 "GeoTIFF file; of --tiles a pattern, like dtm_{x}_{y}.tif")
      .required()
      .value_name("FILE");
  add_terrain_options(app, options);
  // These are filters of points there; here they say what the raster is like.
  app.remove_option("--bounds");
  app.remove_option("--resolution");
  options.own_options = {"--bounds", "--resolution"};
  take_parsed(app.add_option("--clip-bounds", options.input.bounds,
                             "Use points in this box, like --bounds elsewhere"),
              parse_bounds)
      .value_name("BOX")
      .group(kFilterGroup);
  options.uses_crs = true;
  const std::string group = "Raster";
  take_parsed(
      app.add_option("--resolution", options.resolution, "Side of a pixel, in units of x and y"),
      parse_resolution)
      .value_name("R")
      .group(group);
  take_parsed(app.add_option("--bounds", options.bounds, "Cover xmin,ymin,xmax,ymax [all points]"),
              parse_raster_bounds)
      .value_name("BOX")
      .group(group);
  app.add_flag("--force-size", options.force_size,
               "Cover all points, even if outliers make the raster very large")
      .group(group);
  app.add_flag("--align", options.align, "Put edges of pixels on multiples of R").group(group);
  app.add_option("--like", options.like, "Put pixels where this raster has them")
      .value_name("FILE")
      .group(group)
      // Its coordinate system is compared with that of a mesh, too.
      .each([&options](const std::string&) { options.own_options.emplace_back("--force-crs"); });
  add_tiles(app, options.tiles,
            "Cut the raster into squares of this side, or by the polygons of a file")
      .group(group)
      // The coordinate system of polygons is compared with that of a mesh, too.
      .each([&options](const std::string& text) {
        if (!parse_number(text)) options.own_options.emplace_back("--force-crs");
      });
  app.add_option("--vrt", options.vrt, "Of tiles, what puts them together [like -o]")
      .value_name("FILE")
      .group(group);
  take_parsed(app.add_option("--product", options.products,
                             fmt::format("{}, p0 to p100 (percentiles); several, with commas, "
                                         "become bands; or {}, heights above the ground",
                                         fmt::join(plain_product_names(), ", "), kCanopy)),
              [](const std::string& text) {
                DemOptions checked;
                parse_products(text, checked);
              })
      .value_name("LIST")
      .show_default()
      .group(group);
  take_parsed(app.add_option("--ground-class", options.ground_class,
                             "Of chm, points of these classes are the ground [2]")
                  .value_name("LIST"),
              [](const std::string& text) { parse_classes(text); })
      .group(group);
  take_number_between(
      app.add_option("--azimuth", options.azimuth, "Where a hillshade's light comes from"), 0, 360)
      .value_name("DEGREES")
      .show_default()
      .group(group);
  take_number_between(
      app.add_option("--altitude", options.altitude, "Its height above the horizon"), 0, 90)
      .value_name("DEGREES")
      .show_default()
      .group(group);
  take_parsed(app.add_option("--z-factor", options.z_factor,
                             "Multiply heights by this for slopes, shades, curvatures [by units]"),
              parse_factor)
      .value_name("F")
      .group(group);
  add_choice(app, "--gradient", options.gradient, {"horn", "zevenbergen-thorne"},
             "Of slope, aspect and hillshade")
      .group(group);
  app.add_flag("--compute-edges", options.compute_edges,
               "Make slopes and the like also where neighbours have no data")
      .group(group);
  app.add_flag("--clip-pixels", options.input.clips_product,
               "Let --clip leave pixels without data, and use all points")
      .group(group);
  app.add_flag("--fill-voids", options.fill_voids,
               "Give min, max, mean and percentiles of pixels without points the triangle's height")
      .group(group);
  take_parsed(app.add_option("--nodata", options.nodata, "Value of pixels without data"),
              parse_nodata)
      .value_name("V")
      .show_default()
      .group(group);
  add_choice(app, "--type", options.type, {"float32", "byte"},
             "Of pixels; bytes are for hillshades")
      .group(group);
  add_choice(app, "--compress", options.compression, {"deflate", "zstd", "none"},
             "Compression of the file")
      .group(group);
  app.add_flag("--cog", options.cloud_optimized, "Make it cloud optimized, with overviews")
      .group(group);
  add_report_options(app, options.report);
}

DemOptions dem_options(const DemCommandOptions& options) {
  DemOptions dem;
  if (!options.bounds.empty()) {
    refuse_given(*options.app, {"--force-size"}, "with --bounds, which tells what to cover");
  }
  if (options.like.empty()) {
    if (options.resolution.empty()) {
      throw UsageError("--resolution R, the side of a pixel, is missing (or --like FILE)");
    }
    dem.resolution = parse_resolution(options.resolution);
    if (!options.bounds.empty()) dem.bounds = parse_raster_bounds(options.bounds);
    dem.align = options.align;
    dem.many_pixels = options.force_size;
  } else {
    refuse_given(*options.app, {"--resolution", "--bounds", "--align", "--force-size"},
                 "with --like, which tells where all pixels lie");
    dem.like = options.like;
    dem.foreign_crs = options.input.force_crs;
  }
  parse_products(options.products, dem);
  if (options.products == kCanopy) {
    refuse_given(*options.app, {"--tasks", "--resume", "--checkpoint-every"},
                 "with --product chm, which takes two runs");
    refuse_given(*options.app, {"--mesh-format"}, "with --product chm, which is made of points");
  } else {
    refuse_given(*options.app, {"--ground-class"}, "without --product chm");
  }
  check_products(options, dem.products);
  dem.gradient =
      options.gradient == "horn" ? GradientMethod::kHorn : GradientMethod::kZevenbergenThorne;
  dem.compute_edges = options.compute_edges;
  dem.fill_voids = options.fill_voids;
  dem.clip = product_clip(options.input);
  if (options.input.clips_product) dem.foreign_crs = options.input.force_crs;
  dem.type = options.type == "byte" ? PixelType::kByte : PixelType::kFloat32;
  dem.azimuth = options.azimuth;
  dem.altitude = options.altitude;
  if (!options.z_factor.empty()) dem.z_factor = parse_factor(options.z_factor);
  dem.max_edge = max_edge(options);
  dem.nodata = parse_nodata(options.nodata);
  dem.compression = options.compression;
  dem.cloud_optimized = options.cloud_optimized;
  set_tiles(options, dem);
  return dem;
}

}  // namespace spillway::command

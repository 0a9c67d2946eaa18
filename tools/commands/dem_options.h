#pragma once

#include <spillway/dem.h>

#include <string>

#include "tools/commands/terrain_input.h"

namespace spillway::command {

/// The product that is a raster of its own: heights above the ground.
inline constexpr const char* kCanopy = "chm";

/// The command line of `dem`; an empty text is an option that was not given.
struct DemCommandOptions : TerrainOptions {
  std::string output;
  std::string resolution;
  std::string bounds;
  bool align = false;
  bool force_size = false;
  std::string like;
  std::string tiles;
  std::string vrt;
  std::string products = "height";
  std::string ground_class;
  std::string gradient = "horn";
  bool compute_edges = false;
  bool fill_voids = false;
  std::string nodata = "-9999";
  std::string type = "float32";
  std::string compression = "deflate";
  bool cloud_optimized = false;
  double azimuth = 315;
  double altitude = 45;
  std::string z_factor;
};

/// The words that --product has besides kCanopy and percentiles, which have their number there.
std::vector<std::string> plain_product_names();

void add_dem_options(CommandLine& app, DemCommandOptions& options);

/// What is to be made. Throws UsageError for options that are wrong or contradict each other.
DemOptions dem_options(const DemCommandOptions& options);

}  // namespace spillway::command

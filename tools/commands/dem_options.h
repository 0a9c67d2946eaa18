#pragma once

#include <string>
#include <vector>

#include "formats/gdal/raster.h"
#include "stream/sinks/dem.h"
#include "tools/commands/terrain_input.h"

namespace spillway::detail {

/// The command line of `dem`; an empty text is an option that was not given.
struct DemCommandOptions : TerrainOptions {
  std::string output;
  std::string resolution;
  std::string bounds;
  bool align = false;
  bool force_size = false;
  std::string like;
  std::string products = "height";
  std::string nodata = "-9999";
  std::string compression = "deflate";
  bool cloud_optimized = false;
  Light light;
};

void add_dem_options(CommandLine& app, DemCommandOptions& options);

/// What is to be made. Opens the raster of --like, whose grid and coordinate system go to `like`.
/// Throws UsageError for options that are wrong or contradict each other.
DemOptions dem_options(const DemCommandOptions& options, RasterGrid& like);

}  // namespace spillway::detail

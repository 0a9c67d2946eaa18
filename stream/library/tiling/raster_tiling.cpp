#include "stream/library/tiling/raster_tiling.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string_view>

#include "src/error.h"
#include "stream/library/tiling/polygon_tiling.h"
#include "stream/library/tiling/square_tiling.h"

namespace spillway::stream {

std::string vrt_path_of(const std::string& pattern) {
  constexpr std::string_view kSeparators = "_-., ";
  const auto is_separator = [&](char c) { return kSeparators.find(c) != std::string_view::npos; };
  const std::filesystem::path path(pattern);
  std::string stem = std::regex_replace(path.stem().string(), std::regex("\\{[^{}]*\\}"), "_");
  const auto both = [&](char a, char b) { return is_separator(a) && is_separator(b); };
  stem.erase(std::unique(stem.begin(), stem.end(), both), stem.end());
  const std::size_t first = stem.find_first_not_of(kSeparators);
  if (first == std::string::npos) return path.parent_path() / "tiles.vrt";
  stem = stem.substr(first, stem.find_last_not_of(kSeparators) + 1 - first);
  return path.parent_path() / (stem + ".vrt");
}

std::unique_ptr<RasterTiling> make_tiling(const std::string& pattern, const DemOptions& options) {
  refuse_two_kinds(options.tile_side, options.tile_polygons);
  if (!options.vrt.empty() && std::filesystem::path(options.vrt).extension() != ".vrt") {
    throw InvalidArgument(fmt::format("{}: what puts tiles together is a VRT: give it a name that "
                                      "ends in .vrt",
                                      options.vrt),
                          {.file = options.vrt});
  }
  if (options.tile_side != 0) return std::make_unique<SquareTiling>(pattern, options.tile_side);
  if (!options.tile_polygons.empty()) {
    return std::make_unique<PolygonTiling>(pattern, options.tile_polygons);
  }
  if (!options.vrt.empty()) {
    throw InvalidArgument("a VRT puts tiles together, and none are asked for");
  }
  return nullptr;
}

}  // namespace spillway::stream

#include "tools/commands/tile_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "src/geometry/simplex_name.h"
#include "tools/options/command_options.h"
#include "tools/report/usage_error.h"

namespace spillway::command {

Option add_tiles(CommandLine& app, std::string& tiles, const std::string& help) {
  return take_parsed(app.add_option("--tiles", tiles, help), parse_tiles).value_name("SIDE|FILE");
}

TileChoice parse_tiles(const std::string& tiles) {
  if (tiles.empty()) return {};
  const auto side = parse_number(tiles);
  if (!side) return {.polygons = tiles};
  if (*side > 0 && std::isfinite(*side)) return {.side = *side};
  throw UsageError(fmt::format(
      "\"{}\" is no side of tiles; give a number above 0, or a file of polygons", tiles));
}

void refuse_pattern(const std::string& output) {
  const std::string name = std::filesystem::path(output).filename();
  const std::size_t brace = name.find('{');
  if (brace == std::string::npos || name.find('}', brace) == std::string::npos) return;
  throw UsageError(fmt::format("{}: braces in a name are for tiles; give --tiles, too", output));
}

void say_clipped(const Report& report, ProgressLine& progress) {
  if (report.outside_tiles == 0) return;
  progress.say(fmt::format("{} {} clipped, and {} vertices with them", report.outside_tiles,
                           simplices_of(report.dimension), report.outside_vertices));
}

void say_mesh_tiles(const Report& report, const std::string& output, ProgressLine& progress) {
  if (report.outside_tiles > 0) {
    progress.insist(fmt::format("warning: {} {} are in none of the tiles, and in no file",
                                report.outside_tiles, simplices_of(report.dimension)));
  }
  if (report.outside_vertices > 0) {
    progress.insist(
        fmt::format("warning: {} vertices belong to no simplex of a tile, and are in no file",
                    report.outside_vertices));
  }
  progress.say(
      fmt::format("{} tiles with {}", report.output_files, simplices_of(report.dimension)));
  warn_of_other_tiles(report.other_files, output, progress);
}

void warn_of_other_tiles(const std::vector<std::string>& files, const std::string& output,
                         ProgressLine& progress) {
  constexpr std::size_t kMostNamed = 3;
  if (files.empty()) return;
  const std::size_t named = std::min(files.size(), kMostNamed);
  const std::size_t more = files.size() - named;
  progress.insist(fmt::format(
      "warning: {}{} are called like tiles of {}, but this run has not written them",
      fmt::join(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(named), ", "),
      more == 0 ? "" : fmt::format(" and {} more", more), output));
}

}  // namespace spillway::command

#pragma once

#include <spillway/report.h>

#include <string>
#include <vector>

#include "tools/options/command_line.h"
#include "tools/report/progress.h"

namespace spillway::command {

/// What --tiles asks for: squares of a side, or the polygons of a file, or neither.
struct TileChoice {
  double side = 0;
  std::string polygons{};
};

/// Adds --tiles SIDE|FILE.
Option add_tiles(CommandLine& app, std::string& tiles, const std::string& help);

/// What --tiles gives, "" for nothing. Throws UsageError for a side that is none.
TileChoice parse_tiles(const std::string& tiles);

/// Throws UsageError if an output is called like tiles, which are not asked for.
void refuse_pattern(const std::string& output);

/// Says what is left out of a mesh that was clipped.
void say_clipped(const Report& report, ProgressLine& progress);

/// Says to which tiles a mesh has gone.
void say_mesh_tiles(const Report& report, const std::string& output, ProgressLine& progress);

/// Warns of files that an earlier run may have left, which are called like the tiles of `output`.
void warn_of_other_tiles(const std::vector<std::string>& files, const std::string& output,
                         ProgressLine& progress);

}  // namespace spillway::command

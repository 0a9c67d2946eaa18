#include "tools/options/input_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <system_error>

#include "formats/bytes/bytes.h"
#include "formats/disk/file_system.h"
#include "formats/gdal/crs_text.h"
#include "formats/points/point_formats.h"
#include "tools/options/command_options.h"
#include "tools/report/usage_error.h"

namespace spillway::command {

bool InputOptions::filters() const {
  return every > 1 || resolution > 0 || !keep_class.empty() || !where.empty() ||
         !drop_class.empty() || !returns.empty() || !bounds.empty() || !z_range.empty() ||
         !clip.empty() || !thin.empty();
}

void add_input_options(CommandLine& app, InputOptions& options) {
  add_choice(app, "--input-format", options.format, point_format_names(),
             "Format of the points, if neither name nor first bytes tell it");
  take_parsed(
      app.add_option("--crs", options.crs,
                     "Coordinate system of inputs that name none: EPSG:n, WKT, or a file with WKT"),
      parse_crs)
      .value_name("CRS");
  app.add_flag("--force-crs", options.force_crs,
               "Use coordinates as they are, even if coordinate systems differ");
  take_parsed(app.add_option("--to-crs", options.to_crs,
                             "Bring points to this coordinate system, before all else"),
              parse_crs)
      .value_name("CRS");
  take_positive_number(
      app.add_option("--multiply-z", options.z_multiplier,
                     "Multiply heights by this, after that, as 0.3048 for feet in metres"))
      .value_name("F");
  const std::string group = kFilterGroup;
  const auto add = [&](const char* name, std::string& value, const char* type, const char* what) {
    return app.add_option(name, value, what).value_name(type).group(group);
  };
  take_parsed(
      add("--keep-class", options.keep_class, "LIST", "Use points of these classes, as 2,3-5"),
      parse_classes);
  take_parsed(add("--drop-class", options.drop_class, "LIST", "Leave out points of these classes"),
              parse_classes);
  take_parsed(add("--returns", options.returns, "LIST",
                  "Use these returns of a pulse: first, last, single, numbers"),
              parse_returns);
  take_parsed(add("--where", options.where, "CONDITION",
                  "Use points of which this holds, as 'intensity > 200 and class in (2, 9)'"),
              parse_condition);
  take_parsed(add("--bounds", options.bounds, "BOX",
                  "Use points in xmin,ymin,xmax,ymax or xmin,ymin,zmin,xmax,ymax,zmax"),
              parse_bounds);
  take_parsed(
      add("--z-range", options.z_range, "LOW,HIGH", "Use points with heights from low to high"),
      parse_z_range);
  add("--clip", options.clip, "FILE", "Use points in the polygons of this vector file");
  take_number(app.add_option("--clip-buffer", options.clip_buffer,
                             "Use points up to this far from what --clip has, lines and points, "
                             "too; below 0: so far inside"))
      .value_name("D")
      .group(group);
  app.add_flag("--clip-outside", options.clip_outside, "Use the points that --clip leaves out")
      .group(group);
  take_whole_number(
      app.add_option("--every", options.every, "Use records 0, N, 2N, ... of each input"), 1)
      .value_name("N")
      .group(group);
  take_parsed(add("--thin", options.thin, "CELL[:CHOICE]",
                  "Use one point in each grid cell: the first, lowest or highest, or the one at "
                  "its center"),
              parse_thinning);
  take_positive_number(
      app.add_option("--resolution", options.resolution,
                     "Of COPC files, read only the levels needed for points this far apart"))
      .value_name("R")
      .group(group);
  app.add_flag("--keep-withheld", options.keep_withheld,
               "Use points that LAS files flag as withheld, too")
      .group(group);
  app.add_flag("--skip-invalid", options.skip_invalid,
               "Leave out rows of text, npy, PLY and PCD that are not points, and count them")
      .group(group);
  take_whole_number(
      app.add_option(
          "--max-expansion", options.max_expansion,
          "Of compressed text and blocks of VTU, most bytes for each compressed one; more "
          "is an error"),
      1)
      .value_name("N")
      .group(kTableGroup);
  app.add_flag("--salvage", options.salvage,
               "Use the intact points of truncated or damaged LAS and LAZ files; count the rest")
      .group(group);
  app.add_flag("--skip-broken", options.skip_broken,
               "Leave out files that cannot be read; name them at the end, with exit code 1")
      .group(group);
  add_table_options(app, options.table);
}

std::string parse_crs(std::string_view text) {
  constexpr std::uint64_t kLongest = std::uint64_t{1} << 20;
  std::string crs(text);
  if (looks_like_wkt(crs) || crs.starts_with("EPSG:")) return crs;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(crs, ignored)) {
    if (looks_like_crs(crs)) return crs;
    throw UsageError(
        fmt::format("\"{}\" is no coordinate system; give EPSG:n, WKT, or the name of a file "
                    "with WKT (.prj, .wkt)",
                    crs));
  }
  const std::unique_ptr<InputFile> file = disk().open(crs);
  std::vector<std::byte> content(std::min(file->size().value_or(kLongest), kLongest));
  content.resize(file->read(content));
  std::string wkt(as_text(content));
  std::ranges::replace_if(
      wkt, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  wkt.erase(0, wkt.find_first_not_of(' '));
  if (looks_like_crs(wkt)) return wkt;
  throw UsageError(fmt::format("{} holds no WKT of a coordinate system", crs));
}

void parse_condition(const std::string& text) {
  try {
    static_cast<void>(names_in_condition(text));
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
}

Clip clip_of(const InputOptions& options) {
  if (options.clip.empty() &&
      (options.clip_buffer != 0 || options.clip_outside || options.clips_product)) {
    throw UsageError(
        "--clip-buffer, --clip-outside, --clip-pixels and --clip-simplices have no effect without "
        "--clip");
  }
  return {options.clip, options.clip_buffer, options.clip_outside};
}

Clip product_clip(const InputOptions& options) {
  return options.clips_product ? clip_of(options) : Clip{};
}

PointOptions point_options(const InputOptions& options, int dimension) {
  PointOptions points;
  points.dimension = dimension;
  points.format = options.format;
  points.text = text_table(options.table);
  points.skip_invalid = options.skip_invalid;
  points.max_expansion = options.max_expansion;
  points.salvage = options.salvage;
  points.skip_broken = options.skip_broken;
  points.keep_withheld = options.keep_withheld;
  points.every = options.every;
  if (!options.keep_class.empty()) points.classes = parse_classes(options.keep_class);
  if (!options.drop_class.empty()) points.other_classes = parse_classes(options.drop_class);
  points.where = options.where;
  if (!options.returns.empty()) points.returns = parse_returns(options.returns);
  if (!options.bounds.empty()) points.bounds = parse_bounds(options.bounds);
  if (!options.z_range.empty()) points.z_range = parse_z_range(options.z_range);
  const Clip clip = clip_of(options);
  if (!options.clips_product) points.clip = clip;
  if (!options.thin.empty()) points.thin = parse_thinning(options.thin);
  points.resolution = options.resolution;
  if (!options.crs.empty()) points.crs = parse_crs(options.crs);
  points.foreign_crs = options.force_crs;
  if (!options.to_crs.empty()) points.to_crs = parse_crs(options.to_crs);
  points.z_multiplier = options.z_multiplier;
  return points;
}

MeshOptions mesh_options(const InputOptions& options, const std::string& format) {
  MeshOptions mesh;
  mesh.format = format;
  if (!options.crs.empty()) mesh.crs = parse_crs(options.crs);
  mesh.foreign_crs = options.force_crs;
  mesh.max_expansion = options.max_expansion;
  return mesh;
}

}  // namespace spillway::command

#include "tools/options/input_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <system_error>

#include "formats/bytes/bytes.h"
#include "formats/disk/file_system.h"
#include "formats/gdal/crs_text.h"
#include "formats/points/point_formats.h"
#include "tools/options/command_options.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// All of `text` as a T, or nothing.
template <typename T>
std::optional<T> number_of(std::string_view text) {
  T value{};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

bool InputOptions::filters() const {
  return every > 1 || resolution > 0 || !keep_class.empty() || !where.empty() ||
         !drop_class.empty() || !returns.empty() || !bounds.empty() || !z_range.empty() ||
         !clip.empty() || !thin.empty();
}

void add_input_options(CommandLine& app, InputOptions& options) {
  add_choice(app, "--input-format", options.format, point_format_names(),
             "Format of the points, if neither name nor first bytes tell it");
  take_parsed(app.add_option("--columns", options.columns,
                             "Of text, the columns of x, y, z: as 3,2,4, as PNEZD, or by names as "
                             "Easting,Northing,Height")
                  .value_name("LIST"),
              [](const std::string& text) {
                if (parse_column_names(text).empty()) parse_columns(text);
              });
  take_whole_number(app.add_option("--skip-lines", options.skip_lines,
                                   "Of text, leave out so many lines at the top"),
                    0)
      .value_name("N");
  take_parsed(app.add_option("--separator", options.separator,
                             "Of text, what separates columns: comma, semicolon, tab or blanks")
                  .value_name("SIGN"),
              parse_separator);
  take_parsed(
      app.add_option("--decimal", options.decimal, "Of text, the decimal sign: point or comma")
          .value_name("SIGN"),
      parse_decimal);
  app.add_flag("--no-header", options.no_header,
               "Of text, the first line is a row, and comments name no columns");
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
               "Leave out rows of text and npy that are not points, and count them")
      .group(group);
  app.add_flag("--salvage", options.salvage,
               "Use the intact points of truncated or damaged LAS and LAZ files; count the rest")
      .group(group);
  app.add_flag("--skip-broken", options.skip_broken,
               "Leave out files that cannot be read; name them at the end, with exit code 1")
      .group(group);
}

std::vector<std::string> parse_column_names(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ',');
  const auto is_number = [](std::string_view part) {
    return number_of<std::uint64_t>(part).has_value();
  };
  if (parts.size() < 2 || std::ranges::any_of(parts, is_number)) return {};
  const bool valid = parts.size() <= 3 && std::ranges::none_of(parts, &std::string_view::empty);
  if (!valid) {
    throw UsageError(fmt::format(
        "\"{}\" does not name columns; give the names of x, y and z, or of x and y", text));
  }
  return {parts.begin(), parts.end()};
}

namespace {

struct Sign {
  std::string_view name;
  char sign;
};

char sign_of(std::string_view text, std::span<const Sign> signs) {
  std::string names;
  for (const Sign& sign : signs) {
    if (text == sign.name || text == std::string_view(&sign.sign, 1)) return sign.sign;
    names += (names.empty() ? "" : ", ") + std::string(sign.name);
  }
  throw UsageError(fmt::format("\"{}\" is none of these: {}", text, names));
}

}  // namespace

char parse_separator(std::string_view text) {
  constexpr std::array<Sign, 4> kSigns = {
      {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"blanks", ' '}}};
  return sign_of(text, kSigns);
}

char parse_decimal(std::string_view text) {
  constexpr std::array<Sign, 2> kSigns = {{{"point", '.'}, {"comma", ','}}};
  return sign_of(text, kSigns);
}

std::vector<int> parse_columns(std::string_view text) {
  constexpr std::array<std::string_view, 3> kLetters = {"XE", "YN", "ZH"};
  std::vector<int> columns;
  bool valid = true;
  if (std::ranges::all_of(text, [](unsigned char c) { return std::isalpha(c) != 0; })) {
    std::array<int, 3> found{};
    for (std::size_t i = 0; i < text.size(); ++i) {
      const auto letter = static_cast<char>(std::toupper(static_cast<unsigned char>(text[i])));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (kLetters.at(axis).find(letter) == std::string_view::npos) continue;
        valid = valid && found.at(axis) == 0;
        found.at(axis) = static_cast<int>(i) + 1;
      }
    }
    columns.assign(found.begin(), found.end() - (found[2] == 0 ? 1 : 0));
  } else {
    for (const std::string_view part : split(text, ',')) {
      columns.push_back(number_of<std::uint16_t>(part).value_or(0));
    }
  }
  valid = valid && (columns.size() == 2 || columns.size() == 3);
  for (const int column : columns) {
    valid = valid && column > 0 && std::ranges::count(columns, column) == 1;
  }
  if (!valid) {
    throw UsageError(
        fmt::format("\"{}\" does not tell columns; give the numbers of x, y and z, as 3,2,4, or a "
                    "letter for each column, as PNEZD, with one X or E, one Y or N, and at most "
                    "one Z or H",
                    text));
  }
  return columns;
}

std::vector<int> parse_classes(std::string_view text) {
  std::vector<int> classes;
  for (const std::string_view part : split(text, ',')) {
    const std::vector<std::string_view> ends = split(part, '-');
    const auto first = number_of<std::uint8_t>(ends.front());
    const auto last = number_of<std::uint8_t>(ends.back());
    if (!first || !last || ends.size() > 2 || *first > *last) {
      throw UsageError(
          fmt::format("\"{}\" is not a list of classes; give numbers from 0 to 255 "
                      "and ranges, as 2,3-5",
                      text));
    }
    for (int c = *first; c <= *last; ++c) classes.push_back(c);
  }
  return classes;
}

Returns parse_returns(std::string_view text) {
  Returns returns;
  for (const std::string_view part : split(text, ',')) {
    const auto number = number_of<std::uint8_t>(part);
    if (part == "first") {
      returns.first = true;
    } else if (part == "last") {
      returns.last = true;
    } else if (part == "single") {
      returns.single = true;
    } else if (number && *number >= 1 && *number <= 15) {
      returns.numbers.push_back(*number);
    } else {
      throw UsageError(
          fmt::format("\"{}\" is not a choice of returns; give first, last, single, or "
                      "numbers from 1 to 15, separated by commas",
                      text));
    }
  }
  return returns;
}

Extent parse_bounds(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view part : split(text, ',')) {
    numbers.push_back(parse_number(part).value_or(std::nan("")));
  }
  Extent box;
  const std::size_t axes = numbers.size() / 2;
  const bool valid =
      (numbers.size() == 4 || numbers.size() == 6) &&
      std::ranges::none_of(numbers, [](double number) { return std::isnan(number); });
  if (!valid) {
    throw UsageError(
        fmt::format("\"{}\" is not a box; give xmin,ymin,xmax,ymax or "
                    "xmin,ymin,zmin,xmax,ymax,zmax, without blanks",
                    text));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = k < axes ? numbers[k] : -std::numeric_limits<double>::infinity();
    box.high[k] = k < axes ? numbers[axes + k] : std::numeric_limits<double>::infinity();
    if (box.low[k] > box.high[k]) {
      throw UsageError(fmt::format("\"{}\" has a least {} above the most: {} > {}", text, "xyz"[k],
                                   box.low[k], box.high[k]));
    }
  }
  return box;
}

Thin parse_thinning(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ':');
  const std::string_view choice = parts.size() == 2 ? parts.back() : "first";
  Thin thin;
  thin.cell = parse_number(parts.front()).value_or(0);
  if (choice == "lowest") thin.choice = ThinChoice::kLowest;
  if (choice == "highest") thin.choice = ThinChoice::kHighest;
  if (choice == "center") thin.choice = ThinChoice::kCenter;
  const bool known = choice == "first" || thin.choice != ThinChoice::kFirst;
  if (!(thin.cell > 0) || !known || parts.size() > 2) {
    throw UsageError(
        fmt::format("\"{}\" is not of the form 0.5 or 0.5:lowest; give the side of a "
                    "cell, above 0, and first, lowest, highest or center",
                    text));
  }
  return thin;
}

std::string parse_crs(std::string_view text) {
  constexpr std::uint64_t kLongest = std::uint64_t{1} << 20;
  const std::string crs(text);
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

std::array<double, 2> parse_z_range(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ',');
  std::array<double, 2> range{};
  bool valid = parts.size() == range.size();
  for (std::size_t i = 0; valid && i < range.size(); ++i) {
    const auto number = parse_number(parts[i]);
    valid = number.has_value();
    if (valid) range.at(i) = *number;
  }
  if (valid && range[0] <= range[1]) return range;
  throw UsageError(fmt::format(
      "\"{}\" is no range of heights; give the lowest and the highest, as 10,250.5", text));
}

PointOptions point_options(const InputOptions& options, int dimension) {
  PointOptions points;
  points.dimension = dimension;
  points.format = options.format;
  if (!options.columns.empty()) {
    points.column_names = parse_column_names(options.columns);
    if (points.column_names.empty()) points.columns = parse_columns(options.columns);
  }
  points.skip_lines = options.skip_lines;
  if (!options.separator.empty()) points.separator = parse_separator(options.separator);
  if (!options.decimal.empty()) points.decimal = parse_decimal(options.decimal);
  points.no_header = options.no_header;
  points.skip_invalid = options.skip_invalid;
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
  if (options.clip.empty() && (options.clip_buffer != 0 || options.clip_outside)) {
    throw UsageError("--clip-buffer and --clip-outside have no effect without --clip");
  }
  points.clip = options.clip;
  points.clip_buffer = options.clip_buffer;
  points.clip_outside = options.clip_outside;
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
  return mesh;
}

}  // namespace spillway::command

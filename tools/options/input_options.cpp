#include "tools/options/input_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include "formats/points/point_formats.h"
#include "stream/ranks/rank_pipeline.h"
#include "stream/source/input_list.h"
#include "tools/options/command_options.h"
#include "tools/report/usage_error.h"

namespace spillway::detail {
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

PointFilter point_filter(const InputOptions& options) {
  PointFilter filter;
  filter.every = options.every;
  if (!options.keep_class.empty()) {
    filter.classes = parse_classes(options.keep_class);
  }
  if (!options.drop_class.empty()) {
    if (!filter.classes) filter.classes = std::bitset<256>().set();
    *filter.classes &= ~parse_classes(options.drop_class);
  }
  if (!options.returns.empty()) filter.returns = parse_returns(options.returns);
  if (!options.bounds.empty()) filter.bounds = parse_bounds(options.bounds);
  return filter;
}

/// Tells how many inputs have no levels that --resolution could choose from. Throws UsageError if
/// none has.
void check_levels(const std::vector<PointHeader>& headers, Progress& progress) {
  const auto whole = std::ranges::count_if(headers, [](const PointHeader& header) {
    const PointFormat* const format = find_point_format(header.format);
    return format == nullptr || !format->has_levels;
  });
  if (whole == 0) return;
  if (static_cast<std::size_t>(whole) == headers.size()) {
    throw UsageError(
        fmt::format("--resolution: {}; thin the points with --thin instead",
                    whole == 1 ? headers.front().name + " is no COPC file, only these have levels"
                               : "no input is a COPC file, and only these have levels"));
  }
  progress.say(fmt::format(
      "{} of {} inputs are no COPC files, which --resolution is for: these are read whole", whole,
      headers.size()));
}

}  // namespace

bool InputOptions::filters() const {
  return every > 1 || resolution > 0 || !keep_class.empty() || !drop_class.empty() ||
         !returns.empty() || !bounds.empty() || !thin.empty();
}

void add_input_options(CommandLine& app, InputOptions& options) {
  add_choice(app, "--input-format", options.format, point_format_names(),
             "Format of the points, where neither name nor first bytes tell");
  app.add_flag("--force-crs", options.force_crs,
               "Take coordinates as they are, though inputs have different coordinate systems");
  const std::string group = "Filters (of the points that are read)";
  const auto add = [&](const char* name, std::string& value, const char* type, const char* what) {
    return app.add_option(name, value, what).value_name(type).group(group);
  };
  app.add_flag("--keep-withheld", options.keep_withheld,
               "Use points that LAS files flag as withheld, too")
      .group(group);
  take_whole_number(
      app.add_option("--every", options.every, "Use records 0, N, 2N, ... of each input"), 1)
      .value_name("N")
      .group(group);
  take_parsed(
      add("--keep-class", options.keep_class, "LIST", "Use points of these classes, as 2,3-5"),
      parse_classes);
  take_parsed(add("--drop-class", options.drop_class, "LIST", "Leave out points of these classes"),
              parse_classes);
  take_parsed(add("--returns", options.returns, "LIST",
                  "Use these returns of a pulse: first, last, single, numbers"),
              parse_returns);
  take_parsed(add("--bounds", options.bounds, "BOX",
                  "Use points in xmin,ymin,xmax,ymax or xmin,ymin,zmin,xmax,ymax,zmax"),
              parse_bounds);
  take_parsed(
      add("--thin", options.thin, "CELL[:CHOICE]",
          "Use one point a cell of a grid: the first, lowest, highest one or that at its center"),
      parse_thinning);
  take_positive_number(
      app.add_option("--resolution", options.resolution,
                     "Of COPC files, read the levels needed for points so far apart; others whole"))
      .value_name("R")
      .group(group);
}

std::bitset<256> parse_classes(std::string_view text) {
  std::bitset<256> classes;
  for (const std::string_view part : split(text, ',')) {
    const std::vector<std::string_view> ends = split(part, '-');
    const auto first = number_of<std::uint8_t>(ends.front());
    const auto last = number_of<std::uint8_t>(ends.back());
    if (!first || !last || ends.size() > 2 || *first > *last) {
      throw UsageError(
          fmt::format("\"{}\" is no list of classes; give numbers from 0 to 255 "
                      "and ranges, as 2,3-5",
                      text));
    }
    for (unsigned c = *first; c <= *last; ++c) classes.set(c);
  }
  return classes;
}

ReturnFilter parse_returns(std::string_view text) {
  ReturnFilter filter;
  for (const std::string_view part : split(text, ',')) {
    const auto number = number_of<std::uint8_t>(part);
    if (part == "first") {
      filter.first = true;
    } else if (part == "last") {
      filter.last = true;
    } else if (part == "single") {
      filter.single = true;
    } else if (number && *number >= 1 && *number < filter.numbers.size()) {
      filter.numbers.set(*number);
    } else {
      throw UsageError(
          fmt::format("\"{}\" is none; give first, last, single, or "
                      "numbers from 1 to 15, separated by commas",
                      text));
    }
  }
  return filter;
}

Box<3> parse_bounds(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view part : split(text, ',')) {
    numbers.push_back(parse_number(part).value_or(std::nan("")));
  }
  Box<3> box;
  const std::size_t axes = numbers.size() / 2;
  const bool valid =
      (numbers.size() == 4 || numbers.size() == 6) &&
      std::ranges::none_of(numbers, [](double number) { return std::isnan(number); });
  if (!valid) {
    throw UsageError(
        fmt::format("\"{}\" is no box; give xmin,ymin,xmax,ymax or "
                    "xmin,ymin,zmin,xmax,ymax,zmax, without blanks",
                    text));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] = k < axes ? numbers[k] : -std::numeric_limits<double>::infinity();
    box.hi[k] = k < axes ? numbers[axes + k] : std::numeric_limits<double>::infinity();
    if (box.lo[k] > box.hi[k]) {
      throw UsageError(fmt::format("\"{}\" has a least {} above the most: {} > {}", text, "xyz"[k],
                                   box.lo[k], box.hi[k]));
    }
  }
  return box;
}

ThinningRequest parse_thinning(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ':');
  const std::string_view choice = parts.size() == 2 ? parts.back() : "first";
  ThinningRequest thinning;
  thinning.cell = parse_number(parts.front()).value_or(0);
  if (choice == "lowest") thinning.choice = ThinChoice::kLowest;
  if (choice == "highest") thinning.choice = ThinChoice::kHighest;
  if (choice == "center") thinning.choice = ThinChoice::kCenter;
  const bool known = choice == "first" || thinning.choice != ThinChoice::kFirst;
  if (!(thinning.cell > 0) || !known || parts.size() > 2) {
    throw UsageError(
        fmt::format("\"{}\" is not as 0.5 or 0.5:lowest; give the side of a "
                    "cell, above 0, and first, lowest, highest or center",
                    text));
  }
  return thinning;
}

std::unique_ptr<PointSource> make_point_source(FileSystem& files,
                                               const std::vector<std::string>& arguments,
                                               const InputOptions& options, const SourceUse& use,
                                               ScratchFolder& scratch, Progress& progress) {
  PointSourceOptions how;
  how.dimension = use.dimension;
  how.index = use.index;
  how.reader = {.format = options.format,
                .keep_withheld = options.keep_withheld,
                .attributes = use.attributes,
                .resolution = options.resolution};
  how.filter = point_filter(options);
  bool by_height = false;
  if (!options.thin.empty()) {
    how.thinning = parse_thinning(options.thin);
    by_height =
        how.thinning->choice == ThinChoice::kLowest || how.thinning->choice == ThinChoice::kHighest;
    how.thinning->memory = use.memory / kThinningShare;
    how.thinning->scratch = &scratch;
    how.thinning->progress = {
        .begin = [&progress] { progress.begin_inner("thin", "points"); },
        .update =
            [&progress](std::uint64_t done, std::uint64_t points) {
              progress.update_inner(done, static_cast<double>(done) / static_cast<double>(points));
            },
        .end = [&progress](std::uint64_t points) { progress.end_inner(points); }};
  }
  how.force_crs = options.force_crs;
  how.warn = [&progress](std::string_view text) { progress.say(text); };
  how.detail = [&progress](std::string_view text) { progress.detail(text); };
  // Over ranks the exchange of the points is still to come.
  const bool reads_all = use.ranks == nullptr;
  how.progress = [&progress, reads_all](std::uint64_t points, std::optional<double> fraction) {
    progress.update(points, reads_all ? fraction : std::nullopt);
  };
  const bool looks = use.ranks == nullptr || use.ranks->rank() == 0;
  const std::vector<std::string> paths =
      looks ? expand_inputs(arguments, how.warn) : std::vector<std::string>();
  if (std::count(paths.begin(), paths.end(), "-") > 1) {
    throw UsageError("standard input can be read only once: give - once");
  }
  auto source = use.ranks != nullptr ? open_shared_source(files, paths, how, *use.ranks)
                                     : std::make_unique<PointSource>(files, paths, std::move(how));
  if (options.resolution > 0) check_levels(source->headers(), progress);
  if (by_height && !source->has_heights()) {
    throw UsageError(
        fmt::format("--thin {}: the points have no z to choose one by; thin them by "
                    "first or center",
                    options.thin));
  }
  return source;
}

}  // namespace spillway::detail

#include "stream/library/points/opened_points.h"

#include <spillway/input.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "formats/gdal/crs_text.h"
#include "formats/gdal/gdal.h"
#include "formats/points/point_formats.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "stream/library/choice_check.h"
#include "stream/library/context/context_state.h"
#include "stream/library/context/executor.h"
#include "stream/library/given_crs.h"
#include "stream/library/points/attribute_records.h"
#include "stream/library/points/clip_polygons.h"
#include "stream/library/points/public_points.h"
#include "stream/library/products/surface_units.h"

namespace spillway::stream {
namespace {

/// No table of points has more.
constexpr int kMostColumns = 10'000;

void set_classes(const std::vector<int>& classes, bool used, std::bitset<256>& filter) {
  for (const int number : classes) {
    if (number < 0 || number > 255) {
      throw InvalidArgument(fmt::format("{} is not a class of points: these are 0 to 255", number));
    }
    filter.set(static_cast<std::size_t>(number), used);
  }
}

ReturnFilter return_filter(const Returns& returns) {
  ReturnFilter filter{.first = returns.first, .last = returns.last, .single = returns.single};
  for (const int number : returns.numbers) {
    if (number < 1 || number > 15) {
      throw InvalidArgument(
          fmt::format("{} is not a return of a pulse: these are 1 to 15", number));
    }
    filter.numbers.set(static_cast<std::size_t>(number));
  }
  return filter;
}

/// Makes bounds keep such heights alone.
void keep_heights(const std::array<double, 2>& range, std::optional<Box<3>>& bounds) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!(range[0] <= range[1])) {
    throw InvalidArgument(fmt::format("the range of heights has a least of {}, but a most of {}",
                                      range[0], range[1]));
  }
  if (!bounds)
    bounds = Box<3>{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
  bounds->lo[2] = std::max(bounds->lo[2], range[0]);
  bounds->hi[2] = std::min(bounds->hi[2], range[1]);
  if (bounds->lo[2] <= bounds->hi[2]) return;
  throw InvalidArgument("the bounds and the range of heights have no height in common");
}

PointFilter filter_of(const PointOptions& options) {
  PointFilter filter;
  if (options.every == 0)
    throw InvalidArgument("one of every 0 records cannot be taken; give 1 or more");
  filter.every = options.every;
  if (!options.where.empty()) filter.where.emplace(options.where);
  if (!options.classes.empty() || !options.other_classes.empty()) {
    filter.classes.emplace();
    if (options.classes.empty()) filter.classes->set();
    set_classes(options.classes, true, *filter.classes);
    set_classes(options.other_classes, false, *filter.classes);
  }
  if (options.returns) filter.returns = return_filter(*options.returns);
  if (options.bounds) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(options.bounds->low[k] <= options.bounds->high[k])) {
        throw InvalidArgument(fmt::format("the bounds have a least {} of {}, but a most of {}",
                                          "xyz"[k], options.bounds->low[k],
                                          options.bounds->high[k]));
      }
    }
    filter.bounds = Box<3>{options.bounds->low, options.bounds->high};
  }
  if (options.z_range) keep_heights(*options.z_range, filter.bounds);
  return filter;
}

ThinningRequest thinning_of(const Thin& thin, std::uint64_t memory, ScratchFolder& scratch) {
  check_choice(thin.choice, spillway::ThinChoice::kCenter, "choice of a cell's point");
  if (!(thin.cell > 0) || !std::isfinite(thin.cell)) {
    throw InvalidArgument(
        fmt::format("cells of {} do not thin points: give a side above 0", thin.cell));
  }
  return {.cell = thin.cell,
          .choice = thin.choice,
          .memory = memory / kThinningShare,
          .scratch = &scratch};
}

/// Counted from 0, that of z -1 where there is none; nothing if none are chosen.
std::optional<std::array<int, 3>> columns_of(const std::vector<int>& chosen) {
  if (chosen.empty()) return std::nullopt;
  if (chosen.size() != 2 && chosen.size() != 3) {
    throw InvalidArgument(fmt::format("2 or 3 columns are x, y and z, not {}", chosen.size()));
  }
  std::array<int, 3> columns = {0, 0, -1};
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    if (chosen[k] < 1 || chosen[k] > kMostColumns) {
      throw InvalidArgument(fmt::format("there is no column {}: they are counted from 1 to {}",
                                        chosen[k], kMostColumns));
    }
    if (std::ranges::count(chosen, chosen[k]) > 1) {
      throw InvalidArgument(fmt::format("column {} is chosen twice", chosen[k]));
    }
    columns[k] = chosen[k] - 1;
  }
  return columns;
}

/// Characters counted from 0, [first, end).
std::vector<std::array<std::size_t, 2>> characters_of(
    const std::vector<std::array<int, 2>>& chosen) {
  std::vector<std::array<std::size_t, 2>> characters;
  for (const auto& [first, last] : chosen) {
    if (first < 1 || last < first || last > kMostColumns) {
      throw InvalidArgument(
          fmt::format("there are no characters {} to {}: they are counted from 1 to {}", first,
                      last, kMostColumns));
    }
    for (const auto& [begin, end] : characters) {
      if (static_cast<std::size_t>(first) > end || static_cast<std::size_t>(last) <= begin)
        continue;
      throw InvalidArgument(fmt::format("characters {} to {} are in two columns", first, last));
    }
    characters.push_back({static_cast<std::size_t>(first) - 1, static_cast<std::size_t>(last)});
  }
  return characters;
}

/// Throws InvalidArgument for what no text can be like.
TextLayout text_layout_of(const TextTable& table) {
  const auto check = [](const char* name, char sign, std::string_view signs) {
    if (sign == 0 || signs.find(sign) != signs.npos) return;
    throw InvalidArgument(fmt::format("\"{}\" is no {} of text", sign, name));
  };
  check("separator", table.separator, ",;\t ");
  check("decimal sign", table.decimal, ".,");
  if (table.separator == ',' && table.decimal == ',') {
    throw InvalidArgument("commas separate columns, or are decimal signs, not both");
  }
  for (const std::size_t count : {table.column_names.size(), table.characters.size()}) {
    if (count == 0 || count == 2 || count == 3) continue;
    throw InvalidArgument(fmt::format("2 or 3 columns are x, y and z, not {}", count));
  }
  const int ways = (table.columns.empty() ? 0 : 1) + (table.column_names.empty() ? 0 : 1) +
                   (table.characters.empty() ? 0 : 1);
  if (ways > 1 || (table.no_header && !table.column_names.empty())) {
    throw InvalidArgument(
        "columns are chosen by their names, by numbers or by characters, or there are no names");
  }
  if (table.separator != 0 && !table.characters.empty()) {
    throw InvalidArgument("nothing separates columns that are chosen by their characters");
  }
  return {.columns = columns_of(table.columns),
          .names = table.column_names,
          .characters = characters_of(table.characters),
          .skip_lines = table.skip_lines,
          .separator = table.separator,
          .decimal = table.decimal,
          .no_header = table.no_header};
}

/// Throws unless there is an input of which can be said how its text is to be read.
void check_is_text(const std::vector<PointHeader>& headers) {
  const auto is_table = [](const PointHeader& header) {
    const PointFormat* const format = find_point_format(header.format);
    return format != nullptr && format->is_text;
  };
  if (std::ranges::any_of(headers, is_table)) return;
  throw InvalidArgument(fmt::format(
      "{}, so there are no lines and columns to choose",
      headers.size() == 1 ? headers.front().name + " is not text" : "no input is text"));
}

/// Tells how many inputs have no levels that a resolution could choose from. Throws if none has.
void check_levels(const std::vector<PointHeader>& headers, const ContextOptions& tell) {
  const auto whole = std::ranges::count_if(headers, [](const PointHeader& header) {
    const PointFormat* const format = find_point_format(header.format);
    return format == nullptr || !format->has_levels;
  });
  if (whole == 0) return;
  if (static_cast<std::size_t>(whole) == headers.size()) {
    throw InvalidArgument(fmt::format(
        "{}, so there are no levels to choose from by a resolution: thin the points instead",
        whole == 1 ? headers.front().name + " is not a COPC file" : "no input is a COPC file"));
  }
  if (!tell.warning) return;
  tell.warning(
      fmt::format("{} of {} inputs are not COPC files, which have levels to choose from "
                  "by a resolution: these are read whole",
                  whole, headers.size()));
}

}  // namespace

OpenedPoints::OpenedPoints(const std::vector<std::string>& paths, const PointOptions& options,
                           const Context& context)
    : options_(options),
      name_(paths.empty() ? "" : paths.front()),
      scratch_(context.state().scratch(context)),
      context_(context) {
  if (options.dimension != 0 && !is_dimension(options.dimension)) {
    throw InvalidArgument(fmt::format("there are 2 to 6 dimensions, not {}", options.dimension));
  }
  if (options.dimension > 3 && options.thin) {
    throw InvalidArgument(
        fmt::format("points are thinned by cells of 2 or 3 dimensions, not {}", options.dimension));
  }
  if (!(options.resolution >= 0) || std::isinf(options.resolution)) {
    throw InvalidArgument(fmt::format("points are not {} apart: give 0 for all of them, or more",
                                      options.resolution));
  }
  JoinedInputsOptions how = source_options(options, context);
  Executor* const executor = context.options().executor.get();
  is_shared_ = executor != nullptr;
  if (is_shared_) {
    input_ = executor->open_points(context, paths, std::move(how));
  } else {
    const std::vector<std::string> files = expand_inputs(paths, context);
    if (files.empty()) throw InvalidArgument("there are no files to read points from");
    input_ = std::make_unique<stream::JoinedInputs>(context.state().files(), files, std::move(how));
  }
  check_input(options, context);
  input_->carry(attribute_choice(options.attributes));
}

JoinedInputsOptions OpenedPoints::source_options(const PointOptions& options,
                                                 const Context& context) {
  JoinedInputsOptions how;
  how.dimension = options.dimension;
  how.index = true;
  how.reader.format = options.format;
  how.reader.text = text_layout_of(options.text);
  how.reader.skip_invalid = options.skip_invalid;
  how.reader.max_expansion = checked_expansion(options.max_expansion);
  how.reader.salvage = options.salvage;
  how.skip_broken = options.skip_broken;
  how.reader.keep_withheld = options.keep_withheld;
  how.reader.metadata = options.metadata;
  how.reader.resolution = options.resolution;
  how.filter = filter_of(options);
  check_clip(options.clip);
  if (!options.clip.polygons.empty()) {
    const PolygonLayer layer = read_clip(options.clip);
    clip_crs_ = layer.crs;
    how.filter.clip = std::make_shared<ClipArea>(clip_area(layer, options.clip.outside));
  }
  how.crs = {checked_crs(options.crs), options.foreign_crs};
  if (!(options.z_multiplier > 0) || std::isinf(options.z_multiplier)) {
    throw InvalidArgument(
        fmt::format("heights are multiplied by a number above 0, not by {}", options.z_multiplier));
  }
  how.transform = {checked_crs(options.to_crs), options.z_multiplier,
                   std::make_shared<IdleTransforms>()};
  if (context.options().warning) how.warn = context.options().warning;
  if (context.options().detail) how.detail = context.options().detail;
  // Over ranks the exchange of the points is still to come.
  const bool reads_all = context.options().executor == nullptr;
  how.progress = [this, reads_all](std::uint64_t points, std::optional<double> fraction) {
    if (watch_ != nullptr) watch_->tell(points, reads_all ? fraction : std::nullopt);
  };
  if (!options.thin) return how;
  how.thinning = thinning_of(*options.thin, context.memory(), *scratch_);
  how.thinning->progress = {
      .begin =
          [this] {
            if (watch_ != nullptr) watch_->begin_nested("thin", "points");
          },
      .update =
          [this](std::uint64_t done, std::uint64_t points) {
            if (watch_ == nullptr) return;
            watch_->tell_nested(done, static_cast<double>(done) / static_cast<double>(points));
          },
      .end =
          [this](std::uint64_t points) {
            if (watch_ != nullptr) watch_->end_nested(points);
          }};
  return how;
}

void OpenedPoints::check_input(const PointOptions& options, const Context& context) const {
  if (!text_layout_of(options.text).is_none()) check_is_text(input_->headers());
  if (options.resolution > 0) check_levels(input_->headers(), context.options());
  const bool by_height = options.thin && (options.thin->choice == spillway::ThinChoice::kLowest ||
                                          options.thin->choice == spillway::ThinChoice::kHighest);
  if (by_height && !input_->has_heights()) {
    throw InvalidArgument(
        "the points have no z to thin them by: keep the first of a cell, or that at its center");
  }
  if (options.z_range && !input_->has_heights()) {
    throw InvalidArgument("the points have no z to choose them by");
  }
  if (options.z_multiplier != 1) check_multiplied(options, context);
  if (!options.clip.polygons.empty() && !options.foreign_crs) {
    check_same_crs(name_, input_->crs(), options.clip.polygons, clip_crs_, options.clip.polygons);
  }
  if (!options.attributes.empty()) refuse_unknown_names(options.attributes, offered());
}

/// A coordinate system that tells the unit of heights would be false then.
void OpenedPoints::check_multiplied(const PointOptions& options, const Context& context) const {
  if (!input_->has_heights()) throw InvalidArgument("the points have no z to multiply");
  if (!may_tell_heights(input_->crs()) || !options.crs.empty() || !context.options().warning)
    return;
  context.options().warning(
      "warning: heights are multiplied, but the coordinate system still tells the unit that they "
      "had; give another system in its place");
}

AttributeLayout OpenedPoints::offered() const {
  std::vector<AttributeLayout> layouts;
  for (const PointHeader& header : input_->headers()) layouts.push_back(header.attributes);
  return joined(layouts);
}

PointsHeader OpenedPoints::header() const {
  PointsHeader header;
  header.coordinates = input_->has_heights() ? 3 : 2;
  header.count = input_->expected();
  if (const auto& extent = input_->world_extent()) header.extent = Extent{extent->lo, extent->hi};
  header.crs = input_->crs();
  header.lattice = public_lattice(input_->lattice(), input_->heights_on_lattice());
  header.attributes = input_->attributes().attributes();
  return header;
}

bool OpenedPoints::read(std::vector<spillway::Point<3>>& points) {
  spillway::PointsBlock block;
  if (!read(block)) return false;
  points = std::move(block.points);
  return true;
}

bool OpenedPoints::read(spillway::PointsBlock& block) {
  refuse_taken_points(is_taken_);
  PointBlock own;
  if (!input_->read(own)) return false;
  block.points = public_points(input_->lattice(), own.points);
  block.attributes = columns_of(input_->attributes(), own.attributes);
  return true;
}

void OpenedPoints::settle_crs(CrsNeed need) { input_->settle_crs(need); }

RunPoints OpenedPoints::begin(RunWatch& watch, bool index) {
  refuse_taken_points(std::exchange(is_taken_, true));
  watch_ = &watch;
  input_->carry(choice());
  input_->set_index(index || is_shared_);
  return {.stream = input_.get(),
          .files = input_.get(),
          .dimension = options_.dimension,
          .has_heights = input_->has_heights(),
          .heights_on_lattice = input_->heights_on_lattice(),
          .attributes = input_->attributes(),
          .offered = offered(),
          .records = input_->count(),
          .leaves_out = input_->leaves_out(),
          .extent = input_->world_extent(),
          .crs = input_->crs(),
          .name = name_,
          .headers = input_->headers()};
}

}  // namespace spillway::stream

namespace spillway {

std::vector<std::string> names_in_condition(const std::string& condition) {
  return stream::Condition(condition).names();
}

std::unique_ptr<PointSource> open_points(const std::vector<std::string>& paths,
                                         const PointOptions& options, const Context& context) {
  return std::make_unique<stream::OpenedPoints>(paths, options, context);
}

}  // namespace spillway

// The values of options of inputs, read without a command line.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <system_error>

#include "tools/options/command_options.h"
#include "tools/options/input_options.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

/// All of `text` as a T, or nothing.
template <typename T>
std::optional<T> number_of(std::string_view text) {
  T value{};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::optional<double> parse_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double number = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = fault == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(number) ? std::optional(number) : std::nullopt;
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

}  // namespace spillway::command

// The values of options of tables, read without a command line.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <system_error>
#include <vector>

#include "tools/options/command_options.h"
#include "tools/options/table_options.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

/// All of `text` as a number from 1 on, or nothing.
std::optional<int> number_from_one(std::string_view text) {
  std::uint16_t value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size() || value == 0) return std::nullopt;
  return value;
}

/// The columns by their letters; none if one of x, y and z is there twice.
std::vector<int> columns_of_letters(std::string_view text) {
  constexpr std::array<std::string_view, 3> kLetters = {"XE", "YN", "ZH"};
  std::array<int, 3> found{};
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto letter = static_cast<char>(std::toupper(static_cast<unsigned char>(text[i])));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (kLetters.at(axis).find(letter) == std::string_view::npos) continue;
      if (found.at(axis) != 0) return {};
      found.at(axis) = static_cast<int>(i) + 1;
    }
  }
  if (found[0] == 0 || found[1] == 0) return {};
  return {found.begin(), found.end() - (found[2] == 0 ? 1 : 0)};
}

/// "1-10" as 1 and 10, or nothing.
std::optional<std::array<int, 2>> characters_of(std::string_view text) {
  const std::vector<std::string_view> ends = split(text, '-');
  if (ends.size() != 2) return std::nullopt;
  const std::optional<int> first = number_from_one(ends[0]);
  const std::optional<int> last = number_from_one(ends[1]);
  if (!first || !last || *last < *first) return std::nullopt;
  return std::array{*first, *last};
}

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

TextTable text_table(const TableOptions& options) {
  TextTable table;
  if (!options.columns.empty()) parse_columns(options.columns, table);
  table.skip_lines = options.skip_lines;
  if (!options.separator.empty()) table.separator = parse_separator(options.separator);
  if (!options.decimal.empty()) table.decimal = parse_decimal(options.decimal);
  table.no_header = options.no_header;
  return table;
}

void parse_columns(std::string_view text, TextTable& table) {
  const std::vector<std::string_view> parts = split(text, ',');
  const auto is_number = [](std::string_view part) { return number_from_one(part).has_value(); };
  const auto are_characters = [](std::string_view part) { return characters_of(part).has_value(); };
  const auto is_name = [](std::string_view part) {
    return part.find_first_not_of("0123456789-") != part.npos;
  };
  const bool may_be_columns = parts.size() == 2 || parts.size() == 3;
  if (parts.size() == 1 &&
      std::ranges::all_of(text, [](unsigned char c) { return std::isalpha(c) != 0; })) {
    table.columns = columns_of_letters(text);
    if (!table.columns.empty()) return;
  } else if (may_be_columns && std::ranges::all_of(parts, are_characters)) {
    for (const std::string_view part : parts) table.characters.push_back(*characters_of(part));
    return;
  } else if (may_be_columns && std::ranges::all_of(parts, is_number)) {
    for (const std::string_view part : parts) table.columns.push_back(*number_from_one(part));
    const auto is_there_twice = [&](int column) {
      return std::ranges::count(table.columns, column) > 1;
    };
    if (std::ranges::none_of(table.columns, is_there_twice)) return;
  } else if (may_be_columns && std::ranges::all_of(parts, is_name)) {
    table.column_names = {parts.begin(), parts.end()};
    return;
  }
  throw UsageError(
      fmt::format("\"{}\" does not tell columns; give x, y and z by numbers, as 3,2,4, by names, "
                  "by characters, "
                  "as 1-10,11-20,21-28, or a letter for each column, as PNEZD",
                  text));
}

char parse_separator(std::string_view text) {
  constexpr std::array<Sign, 4> kSigns = {
      {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"blanks", ' '}}};
  return sign_of(text, kSigns);
}

char parse_decimal(std::string_view text) {
  constexpr std::array<Sign, 2> kSigns = {{{"point", '.'}, {"comma", ','}}};
  return sign_of(text, kSigns);
}

}  // namespace spillway::command

#include "formats/points/text/unnamed_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kCoordinates = 3;
/// Fewer rows show no order.
constexpr std::size_t kFewestRows = 3;
/// So many of 100 numbers of measured coordinates have decimals, at the least: some end in zeros
/// that were left out.
constexpr std::size_t kDecimalsOf100 = 80;

/// Whether each field of the column is a whole number, one more than that of the row before.
bool counts(std::span<const UnnamedRow> rows) {
  std::optional<std::uint64_t> before;
  for (const UnnamedRow& row : rows) {
    const std::optional<std::uint64_t> number = parse_count(row.first[0]);
    if (!number || (before && *number != *before + 1)) return false;
    before = number;
  }
  return true;
}

bool are_whole(std::span<const UnnamedRow> rows) {
  return std::ranges::all_of(
      rows, [](const UnnamedRow& row) { return parse_count(row.first[0]).has_value(); });
}

bool have_decimals(std::span<const UnnamedRow> rows, std::size_t column) {
  const auto some = std::ranges::count_if(rows, [&](const UnnamedRow& row) {
    return row.first[column].find_first_of(".,") != std::string_view::npos;
  });
  return static_cast<std::size_t>(some) * 100 >= kDecimalsOf100 * rows.size();
}

/// As along a row of a grid.
bool stays(std::span<const UnnamedRow> rows, std::size_t column) {
  return std::ranges::all_of(
      rows, [&](const UnnamedRow& row) { return row.first[column] == rows.front().first[column]; });
}

std::string as_they_stand(const UnnamedRow& row) {
  return fmt::format("x would be {}, y {} and z {}", quoted(row.first[0]), quoted(row.first[1]),
                     quoted(row.first[2]));
}

}  // namespace

UnnamedColumns judge_unnamed_columns(std::span<const UnnamedRow> rows) {
  const bool has_more =
      std::ranges::all_of(rows, [](const UnnamedRow& row) { return row.count > kCoordinates; });
  if (rows.size() < kFewestRows || !has_more) return {};
  const UnnamedRow& row = rows.front();
  if (counts(rows)) {
    const std::string counted =
        fmt::format("the first of {} columns without names counts ({}, {}, {}, ...)", row.count,
                    rows[0].first[0], rows[1].first[0], rows[2].first[0]);
    if (stays(rows, 1)) return {.fault{}, .notice = counted + ", and is taken for x"};
    return {.fault = fmt::format("{}, and may be the number of a point: {}", counted,
                                 as_they_stand(row)),
            .notice{}};
  }
  if (are_whole(rows) && have_decimals(rows, 1) && have_decimals(rows, 2)) {
    return {.fault = fmt::format("the first of {} columns without names has whole numbers, the "
                                 "next two have decimals, so it may be the number of a point: {}",
                                 row.count, as_they_stand(row)),
            .notice{}};
  }
  return {};
}

}  // namespace spillway::formats

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/line_reader.h"
#include "formats/points/common/text_layout.h"
#include "formats/points/text/text_columns.h"

namespace spillway::formats {

/// What the beginning of a text settles for all of it, as docs/formats-points.md ("Text") says.
struct TextOpening {
  TextColumns columns;
  /// The line of the first point, which is the one that `lines` gave last; nothing if there is
  /// none.
  std::optional<std::string_view> first_row;
  /// PTS: the number in the line before the first point, and that line's number.
  std::optional<std::uint64_t> scan_points;
  std::uint64_t scan_line = 0;
  std::uint64_t invalid = 0;         ///< rows that were left out before the first point
  std::vector<std::string> names;    ///< of all columns; none if they have no names
  std::vector<std::string> notices;  ///< of what was taken where the file leaves some doubt
};

/// How rows are to be read.
struct TextRows {
  TextLayout layout{};
  bool skip_invalid = false;  ///< rows that are no points are left out
};

/// Reads up to the first point. Throws Failure that names `name` and the line for
/// a header that does not say which columns are x and y, and for a first row whose columns cannot
/// be told for sure.
TextOpening read_text_opening(LineReader& lines, const std::string& name,
                              const TextRows& rows = {});

/// The number of points that a line of PTS with nothing else tells; nothing for any other line.
std::optional<std::uint64_t> point_count_of_line(std::string_view line);

}  // namespace spillway::formats

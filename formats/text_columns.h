#pragma once
// The grammar of one line of a text point file, as docs/formats-points.md ("Text") describes it.

#include <optional>
#include <string_view>
#include <vector>

#include "src/geometry/point.h"

namespace spillway {

/// Which columns of a line hold x, y and z.
class TextColumns {
 public:
  /// The first two or three columns.
  static TextColumns first(int coordinates);

  /// The columns that a header line names; nothing if it does not name both x and y.
  static std::optional<TextColumns> named(std::string_view header_line);

  /// 2 or 3.
  [[nodiscard]] int coordinates() const { return coordinates_; }

  /// Reads the coordinates; false if one of the columns is missing or no number. Numbers are read
  /// to the nearest double; "inf" and "nan" are numbers.
  [[nodiscard]] bool parse(std::string_view line, Point<3>& point) const;

  /// Whether blanks, commas and semicolons are mixed between the columns that are read, as they are
  /// where a comma is meant as a decimal point. Only for a line that parse() takes.
  [[nodiscard]] bool mixes_separators(std::string_view line) const;

 private:
  std::vector<int> axes_;  // for each column up to the last that is read: its axis, or -1
  int coordinates_ = 0;
};

/// Number of columns of a line, comments at its end not counted.
int column_count(std::string_view line);

/// True for a line without data: blank, or beginning with #, // or %.
bool is_comment(std::string_view line);

/// True if none of the line's first three columns is a number, so that it can only name the
/// columns.
bool is_header(std::string_view line);

}  // namespace spillway

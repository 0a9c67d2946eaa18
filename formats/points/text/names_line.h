#pragma once
// Lines that name the columns of a text, and comments that do: docs/formats-points.md ("Text").

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/points/text/column_names.h"
#include "formats/points/text/text_columns.h"

namespace spillway::formats {

/// All separators, in the order in which they are looked for.
inline constexpr std::array kSeparators = {Separator::kSemicolon, Separator::kTab,
                                           Separator::kComma, Separator::kBlanks};

/// Without blanks, and line ends of other systems, around it.
std::string_view trimmed(std::string_view text);

/// The first separator of kSeparators that occurs in the line, outside of quotes.
Separator likely_separator(std::string_view line);

/// The text of a comment, without the sign that makes it one.
std::string_view text_of_comment(std::string_view line);

/// A line of names, read.
struct NamesLine {
  Separator separator;
  std::vector<std::string_view> names;
  ColumnChoice choice;
};

/// With the first separator that makes sense of the names. Tabs may also be mere blanks.
NamesLine read_names(std::string_view line);
/// The same with this separator.
NamesLine read_names(std::string_view line, Separator separator);

/// A comment that names x and y.
class CommentHeader {
 public:
  /// Nothing, if the comment names no x or no y. A label before a colon is left out, if the names
  /// stand after it.
  static std::optional<CommentHeader> read(std::string_view comment, std::uint64_t line);

  [[nodiscard]] std::uint64_t line() const { return line_; }
  [[nodiscard]] NamesLine names() const { return read_names(text_); }

  /// Whether most words are names of columns, and not those of a sentence. Where x and y may be
  /// words of one, and no z is named, all have to be.
  static bool is_list(const NamesLine& names);

  /// Whether it names the columns of a row that has as many.
  static bool is_header(const NamesLine& names);

  /// Whether x, y and z, if it is named, are columns 1 to 3.
  static bool in_order(const NamesLine& names);

 private:
  CommentHeader(std::string_view text, std::uint64_t line);

  /// Whether x and y are named, and not given, as in "E: 500000, N: 5400000".
  [[nodiscard]] bool names_plane() const;

  std::string text_;
  std::uint64_t line_;
};

}  // namespace spillway::formats

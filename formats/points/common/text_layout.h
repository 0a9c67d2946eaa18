#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace spillway::formats {

/// What is said of a text beforehand; what is not is found from the text itself, as
/// docs/formats-points.md ("Text") tells.
struct TextLayout {
  /// The columns of x, y and z, counted from 0; that of z is -1 where there is none. They go before
  /// what names and rows tell.
  std::optional<std::array<int, 3>> columns{};
  /// Or their names, two or three, in any case of letters.
  std::vector<std::string> names{};
  /// Or the characters of x, y and z in each line, [first, end), counted from 0.
  std::vector<std::array<std::size_t, 2>> characters{};
  std::uint64_t skip_lines = 0;  ///< lines before the first one that is looked at
  char separator = 0;            ///< a comma, a semicolon, a tab, or a blank for any of these
  char decimal = 0;              ///< a point or a comma
  bool no_header = false;        ///< the first line is a row, and comments name no columns

  [[nodiscard]] bool is_none() const {
    return !columns && names.empty() && characters.empty() && skip_lines == 0 && separator == 0 &&
           decimal == 0 && !no_header;
  }
};

/// How a text was understood.
struct TextFacts {
  std::string separator{};           ///< "comma", "semicolon", "tab", "blanks", or "none"
  char decimal = '.';                ///< the sign
  std::vector<std::string> names{};  ///< of all columns; none if they have no names
  std::vector<int> columns{};        ///< of x, y and z, counted from 0
  std::vector<std::array<std::size_t, 2>> characters{};  ///< or these, as TextLayout has them
  bool counts_downwards = false;                         ///< z is its number with the other sign
  std::uint64_t first_line = 0;           ///< of the first row, from 1; 0: there is none
  std::vector<std::string> first_rows{};  ///< up to three, up to 500 bytes of each
};

}  // namespace spillway::formats

#pragma once

#include <array>
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
  std::uint64_t skip_lines = 0;  ///< lines before the first one that is looked at
  char separator = 0;            ///< a comma, a semicolon, a tab, or a blank for any of these
  char decimal = 0;              ///< a point or a comma
  bool no_header = false;        ///< the first line is a row, and comments name no columns

  [[nodiscard]] bool is_none() const {
    return !columns && names.empty() && skip_lines == 0 && separator == 0 && decimal == 0 &&
           !no_header;
  }
};

}  // namespace spillway::formats

#include "formats/inputs/unread_points.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <string>

#include "formats/bytes/fields.h"

namespace spillway::formats {
namespace {

struct Beginning {
  std::string_view text;  ///< in capital letters
  std::string_view what;
};

constexpr std::array kBeginnings = {
    Beginning{"ASTM-E57", "E57"},
};

/// Whether all of the line is so many numbers.
bool has_numbers(std::string_view line, std::size_t count) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  Fields fields(line);
  for (std::size_t n = 0; n < count; ++n) {
    if (!fields.number()) return false;
  }
  return fields.at_end();
}

/// Two counts, the scanner's place, its three axes, and the rows of a matrix.
bool is_ptx(std::string_view text) {
  for (const std::size_t count : {1, 1, 3, 3, 3, 3, 4}) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos || !has_numbers(text.substr(0, end), count)) return false;
    text.remove_prefix(end + 1);
  }
  return true;
}

}  // namespace

std::string_view unread_points(std::string_view first_bytes) {
  std::string begin(first_bytes.substr(0, 16));
  std::ranges::transform(begin, begin.begin(), [](unsigned char c) { return std::toupper(c); });
  for (const Beginning& beginning : kBeginnings) {
    if (begin.starts_with(beginning.text)) return beginning.what;
  }
  return is_ptx(first_bytes) ? "a scan in PTX" : "";
}

}  // namespace spillway::formats

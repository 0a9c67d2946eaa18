#include "formats/meshes/common/mesh_text.h"

#include <fmt/compile.h>
#include <fmt/format.h>

namespace spillway::detail {
namespace {

// No line is longer: four numbers of at most 24 characters, and a short keyword.
constexpr std::size_t kLongestLine = 160;

char* text(std::byte* bytes) { return reinterpret_cast<char*>(bytes); }
std::byte* bytes(char* text) { return reinterpret_cast<std::byte*>(text); }

}  // namespace

void append_coordinates(BufferedOutput& output, std::string_view before, const WorldPoint& point) {
  char* const at = text(output.reserve(kLongestLine));
  output.advance_to(
      bytes(fmt::format_to(at, FMT_COMPILE("{}{} {} {}"), before, point[0], point[1], point[2])));
}

void append_number(BufferedOutput& output, std::string_view before, std::uint64_t number) {
  char* const at = text(output.reserve(kLongestLine));
  output.advance_to(bytes(fmt::format_to(at, FMT_COMPILE("{}{}"), before, number)));
}

void append_simplex(BufferedOutput& output, std::string_view keyword,
                    std::span<const std::uint64_t> corners, std::uint64_t first) {
  char* at = text(output.reserve(kLongestLine));
  at = fmt::format_to(at, FMT_COMPILE("{}"), keyword);
  for (const std::uint64_t corner : corners) {
    at = fmt::format_to(at, FMT_COMPILE(" {}"), corner + first);
  }
  *at++ = '\n';
  output.advance_to(bytes(at));
}

void append_line_end(BufferedOutput& output) { output.append("\n"); }

}  // namespace spillway::detail

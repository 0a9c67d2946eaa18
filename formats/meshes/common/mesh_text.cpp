#include "formats/meshes/common/mesh_text.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include "formats/bytes/bytes.h"
#include "formats/bytes/number_type.h"

namespace spillway::formats {
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

void append_numbers(BufferedOutput& output, const AttributeLayout& layout,
                    std::span<const std::byte> record) {
  for (const AttributeField& field : layout.fields()) {
    const std::byte* number = record.data() + field.at;
    for (std::size_t e = 0; e < field.attribute.elements; ++e) {
      number = with_number_type(field.attribute.type, [&](auto of_type) {
        const auto value = load<decltype(of_type)>(number);
        char* const at = text(output.reserve(kLongestLine));
        output.advance_to(bytes(fmt::format_to(at, FMT_COMPILE(" {}"), +value)));
        return number + sizeof(value);
      });
    }
  }
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

}  // namespace spillway::formats

#include "formats/points/ply/ply_writer.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "formats/bytes/notes.h"
#include "formats/points/attributes/unique_names.h"
#include "formats/points/ply/ply_properties.h"
#include "formats/points/rows/row_writer.h"

namespace spillway::formats {
namespace {

constexpr std::array<const char*, 3> kCoordinates = {"x", "y", "z"};
std::string property_lines(int coordinates, const AttributeLayout& attributes) {
  std::string lines;
  for (int axis = 0; axis < coordinates; ++axis) {
    lines += fmt::format("property double {}\n", kCoordinates[axis]);
  }
  UniqueNames names({kCoordinates.begin(), kCoordinates.end()});
  return lines + ply_property_lines(attributes, names);
}

/// Its length does not depend on the count: a comment makes up for digits.
std::string header_text(const std::vector<std::string>& notes, std::uint64_t count,
                        const std::string& properties) {
  constexpr std::size_t kMostDigits = 20;  // of a number of 64 bits
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& note : notes) text += "comment " + note + '\n';
  const std::string number = fmt::format("{}", count);
  text += fmt::format("comment points{}\n", std::string(kMostDigits - number.size(), ' '));
  return text + fmt::format("element vertex {}\n{}end_header\n", number, properties);
}

}  // namespace

std::unique_ptr<PointWriter> open_ply_point_writer(std::unique_ptr<OutputFile> file,
                                                   const PointWriterOptions& options) {
  RowFormat format{.attributes = as_ply(options.attributes), .header = {}};
  format.header = [notes = crs_notes(options.crs),
                   properties = property_lines(options.coordinates, format.attributes)](
                      std::uint64_t count) { return header_text(notes, count, properties); };
  format.check = PlyIntegerCheck(options.attributes, "point", file->name());
  return open_row_writer(std::move(file), options, std::move(format));
}

}  // namespace spillway::formats

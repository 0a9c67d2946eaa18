#include "formats/points/ply/ply_writer.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "formats/bytes/notes.h"
#include "formats/bytes/number_type.h"
#include "formats/ply/ply_header.h"
#include "formats/points/attributes/unique_names.h"
#include "formats/points/rows/row_encoder.h"
#include "formats/points/rows/row_writer.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

constexpr std::array<const char*, 3> kCoordinates = {"x", "y", "z"};
constexpr double kLargestExact = 0x1p53;

/// Without scales and 64-bit integers, which PLY does not have.
AttributeLayout as_ply(const AttributeLayout& layout) {
  std::vector<Attribute> attributes = without_scales(layout).attributes();
  for (Attribute& attribute : attributes) {
    if (!ply_type(attribute.type)) attribute.type = NumberType::kFloat64;
  }
  return AttributeLayout(std::move(attributes));
}

/// Readers take names for one word, and do not tell X from x.
std::string property_name(std::string name) {
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f) c = '_';
  }
  return name.empty() ? "_" : name;
}

std::string property_lines(int coordinates, const AttributeLayout& attributes) {
  std::string lines;
  UniqueNames names({kCoordinates.begin(), kCoordinates.end()});
  for (int axis = 0; axis < coordinates; ++axis) {
    lines += fmt::format("property double {}\n", kCoordinates[axis]);
  }
  for (const AttributeField& field : attributes.fields()) {
    const Attribute& attribute = field.attribute;
    for (std::size_t e = 0; e < attribute.elements; ++e) {
      std::string name = property_name(attribute.name);
      if (attribute.elements > 1) name += fmt::format("_{}", e + 1);
      lines += fmt::format("property {} {}\n", *ply_type(attribute.type), names.take(name));
    }
  }
  return lines;
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

/// Makes sure that the integers of 64 bits which become doubles are doubles.
class IntegerCheck {
 public:
  IntegerCheck(AttributeLayout layout, std::string file)
      : layout_(std::move(layout)), file_(std::move(file)) {}

  void operator()(std::span<const std::byte> records, std::uint64_t first) const {
    const std::size_t size = layout_.record_size();
    for (const AttributeField& field : layout_.fields()) {
      if (ply_type(field.attribute.type)) continue;
      for (std::size_t at = 0; at < records.size(); at += size) {
        check(field.attribute, &records[at + field.at], first + at / size);
      }
    }
  }

 private:
  void check(const Attribute& attribute, const std::byte* numbers, std::uint64_t point) const {
    for (std::size_t e = 0; e < attribute.elements; ++e, numbers += size_of(attribute.type)) {
      const double value = load_number(attribute.type, numbers);
      if (value > -kLargestExact && value < kLargestExact) continue;
      throw CannotWrite(
          file_,
          fmt::format("point {} has {} for {}, and PLY, without integers of 64 bits, holds none "
                      "beyond 2^53; write spp",
                      point, value, attribute.name),
          ErrorCode::kTooLarge, at_record(point), Remedy::kAttributes);
    }
  }

  AttributeLayout layout_;  // of what comes
  std::string file_;
};

}  // namespace

std::unique_ptr<PointWriter> open_ply_point_writer(std::unique_ptr<OutputFile> file,
                                                   const PointWriterOptions& options) {
  RowFormat format{.attributes = as_ply(options.attributes), .header = {}};
  format.header = [notes = crs_notes(options.crs),
                   properties = property_lines(options.coordinates, format.attributes)](
                      std::uint64_t count) { return header_text(notes, count, properties); };
  format.check = IntegerCheck(options.attributes, file->name());
  return open_row_writer(std::move(file), options, std::move(format));
}

}  // namespace spillway::detail

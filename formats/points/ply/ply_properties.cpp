#include "formats/points/ply/ply_properties.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "formats/bytes/number_type.h"
#include "formats/ply/ply_header.h"
#include "formats/points/rows/row_encoder.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr double kLargestExact = 0x1p53;

/// Readers take names for one word.
std::string property_name(std::string name) {
  for (char& c : name) {
    if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f) c = '_';
  }
  return name.empty() ? "_" : name;
}

/// Readers do not tell X from x.
std::string unique_name(const std::string& name, UniqueNames& names) {
  std::string lower = name;
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  const std::string taken = names.take(lower);
  return taken == lower ? name : taken;
}

}  // namespace

AttributeLayout as_ply(const AttributeLayout& layout) {
  std::vector<Attribute> attributes = without_scales(layout).attributes();
  for (Attribute& attribute : attributes) {
    if (!ply_type(attribute.type)) attribute.type = NumberType::kFloat64;
  }
  return AttributeLayout(std::move(attributes));
}

std::string ply_property_lines(const AttributeLayout& attributes, UniqueNames& names) {
  std::string lines;
  for (const AttributeField& field : attributes.fields()) {
    const Attribute& attribute = field.attribute;
    for (std::size_t e = 0; e < attribute.elements; ++e) {
      std::string name = property_name(attribute.name);
      if (attribute.elements > 1) name += fmt::format("_{}", e + 1);
      lines += fmt::format("property {} {}\n", *ply_type(attribute.type), unique_name(name, names));
    }
  }
  return lines;
}

void PlyIntegerCheck::operator()(std::span<const std::byte> records, std::uint64_t first) const {
  const std::size_t size = layout_.record_size();
  for (const AttributeField& field : layout_.fields()) {
    if (ply_type(field.attribute.type)) continue;
    for (std::size_t at = 0; at < records.size(); at += size) {
      check(field.attribute, &records[at + field.at], first + at / size);
    }
  }
}

void PlyIntegerCheck::check(const Attribute& attribute, const std::byte* numbers,
                            std::uint64_t item) const {
  for (std::size_t e = 0; e < attribute.elements; ++e, numbers += size_of(attribute.type)) {
    const double value = load_number(attribute.type, numbers);
    if (value > -kLargestExact && value < kLargestExact) continue;
    throw CannotWrite(
        file_,
        fmt::format("{} {} has {} for {}, and PLY, without integers of 64 bits, holds none "
                    "beyond 2^53; write {}",
                    item_, item, value, attribute.name, item_ == "point" ? "spp" : "spm"),
        ErrorCode::kTooLarge, at_record(item), Remedy::kAttributes);
  }
}

}  // namespace spillway::formats

#include "formats/meshes/common/colour.h"

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"

namespace spillway::formats {
namespace {

constexpr std::array<std::string_view, 3> kNames = {"red", "green", "blue"};
constexpr unsigned kLargestByte = 255;

bool is_channel(const Attribute& attribute) {
  const bool is_known =
      attribute.type == NumberType::kUint8 || attribute.type == NumberType::kUint16;
  return is_known && attribute.elements == 1 && attribute.scale == 1 && attribute.offset == 0;
}

std::optional<ColourFields> colours_of_16_bits(const AttributeLayout& layout) {
  std::optional<ColourFields> fields = colour_fields(layout);
  if (fields && fields->front().attribute.type != NumberType::kUint16) fields.reset();
  return fields;
}

}  // namespace

std::optional<ColourFields> colour_fields(const AttributeLayout& layout) {
  ColourFields fields;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const AttributeField* const field = layout.find(kNames[i]);
    if (field == nullptr || !is_channel(field->attribute)) return std::nullopt;
    fields[i] = *field;
    if (field->attribute.type != fields[0].attribute.type) return std::nullopt;
  }
  return fields;
}

AttributeChoice colour_choice() {
  return {.names = std::vector<std::string>(kNames.begin(), kNames.end())};
}

AttributeLayout with_byte_colours(const AttributeLayout& layout) {
  if (!colours_of_16_bits(layout)) return layout;
  std::vector<Attribute> attributes = layout.attributes();
  for (Attribute& attribute : attributes) {
    for (const std::string_view name : kNames) {
      if (attribute.name == name) attribute.type = NumberType::kUint8;
    }
  }
  return AttributeLayout(std::move(attributes));
}

ColourDepth::ColourDepth(const AttributeLayout& layout)
    : fields_(colours_of_16_bits(layout)), record_size_(layout.record_size()) {}

void ColourDepth::add(std::span<const std::byte> records) {
  if (!fields_ || exceeds_) return;
  unsigned bits = 0;
  for (const AttributeField& field : *fields_) {
    for (std::size_t at = field.at; at < records.size(); at += record_size_) {
      bits |= load<std::uint16_t>(&records[at]);
    }
  }
  if (bits > kLargestByte) exceeds_ = true;
}

}  // namespace spillway::formats

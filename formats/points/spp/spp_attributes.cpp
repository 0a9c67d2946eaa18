#include "formats/points/spp/spp_attributes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/points/spp/spp_format.h"

namespace spillway::formats {
namespace {

/// Bytes of a block that are not its columns' numbers, at most.
constexpr std::size_t kBlockHead = 65536;
constexpr std::size_t kMostAttributes = 4096;
constexpr std::size_t kMostNumbers = 65536;  // of a point

template <typename T>
void append_value(std::vector<std::byte>& out, const T& value) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(&value, 1));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

void append_text(std::vector<std::byte>& out, const std::string& text) {
  append_value(out, static_cast<std::uint32_t>(text.size()));
  const std::span<const std::byte> bytes = as_bytes_of(text);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

std::string take_text(BlockStream& stream) {
  const auto size = stream.take<std::uint32_t>();
  if (size > stream.left().size()) stream.fail("a text of the header ends early");
  std::string text(size, '\0');
  for (char& c : text) c = stream.take<char>();
  return text;
}

Attribute take_attribute(BlockStream& stream) {
  Attribute attribute;
  attribute.name = take_text(stream);
  const auto type = stream.take<std::uint8_t>();
  if (type > static_cast<std::uint8_t>(NumberType::kFloat64)) {
    stream.fail("an attribute is of an unknown type");
  }
  attribute.type = static_cast<NumberType>(type);
  attribute.elements = stream.take<std::uint64_t>();
  attribute.scale = stream.take<double>();
  attribute.offset = stream.take<double>();
  attribute.unit = take_text(stream);
  attribute.description = take_text(stream);
  if (attribute.elements == 0 || attribute.elements > kMostNumbers) {
    stream.fail("an attribute has an impossible number of elements");
  }
  if (!std::isfinite(attribute.scale) || attribute.scale == 0 || !std::isfinite(attribute.offset)) {
    stream.fail("an attribute has an invalid scale or offset");
  }
  return attribute;
}

/// Calls f(place in the record, bytes) for each number of a point.
template <typename F>
void for_each_number(const AttributeLayout& layout, F&& f) {
  for (const AttributeField& field : layout.fields()) {
    const std::size_t size = size_of(field.attribute.type);
    for (std::size_t e = 0; e < field.attribute.elements; ++e) f(field.at + e * size, size);
  }
}

}  // namespace

std::size_t numbers_of_point(const AttributeLayout& layout) {
  std::size_t numbers = 0;
  for (const AttributeField& field : layout.fields()) numbers += field.attribute.elements;
  return numbers;
}

std::size_t spp_block_points(const AttributeLayout& layout) {
  const std::size_t point = (3 + numbers_of_point(layout)) * sizeof(std::uint64_t);
  return std::clamp<std::size_t>((kSppLargestBlock - kBlockHead) / point, 1, kSppBlockPoints);
}

void append_attribute_list(std::vector<std::byte>& content, const AttributeLayout& layout) {
  append_value(content, static_cast<std::uint32_t>(layout.fields().size()));
  for (const AttributeField& field : layout.fields()) {
    const Attribute& attribute = field.attribute;
    append_text(content, attribute.name);
    append_value(content, static_cast<std::uint8_t>(attribute.type));
    append_value(content, std::uint64_t{attribute.elements});
    append_value(content, attribute.scale);
    append_value(content, attribute.offset);
    append_text(content, attribute.unit);
    append_text(content, attribute.description);
  }
}

AttributeLayout take_attribute_list(BlockStream& stream) {
  const auto count = stream.take<std::uint32_t>();
  if (count == 0 || count > kMostAttributes) {
    stream.fail("the header has an impossible number of attributes");
  }
  std::vector<Attribute> attributes;
  for (std::uint32_t i = 0; i < count; ++i) attributes.push_back(take_attribute(stream));
  AttributeLayout layout(std::move(attributes));
  if (numbers_of_point(layout) > kMostNumbers) stream.fail("points have too many attributes");
  return layout;
}

void append_attribute_columns(std::vector<std::byte>& content, const AttributeLayout& layout,
                              std::span<const std::byte> records) {
  if (layout.empty()) return;
  const std::size_t record = layout.record_size();
  std::vector<std::uint64_t> column(records.size() / record);
  for_each_number(layout, [&](std::size_t at, std::size_t size) {
    for (std::size_t i = 0; i < column.size(); ++i) {
      column[i] = 0;
      std::memcpy(&column[i], &records[i * record + at], size);
    }
    append_column(content, column);
  });
}

bool read_attribute_columns(ColumnReader& columns, const AttributeLayout& layout, std::size_t count,
                            std::vector<std::byte>& records) {
  const std::size_t record = layout.record_size();
  const std::size_t before = records.size();
  records.resize(before + count * record);
  std::vector<std::uint64_t> column;
  bool valid = true;
  for_each_number(layout, [&](std::size_t at, std::size_t size) {
    columns.read(count, column);
    for (std::size_t i = 0; i < count; ++i) {
      valid &= size == sizeof(std::uint64_t) || column[i] >> (8 * size) == 0;
      std::memcpy(&records[before + i * record + at], &column[i], size);
    }
  });
  return valid;
}

}  // namespace spillway::formats

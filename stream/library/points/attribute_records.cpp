#include "stream/library/points/attribute_records.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>

#include "formats/points/attributes/attribute_names.h"

namespace spillway::stream {
namespace {

/// Moves items of `size` bytes between places that are `from_step` and `to_step` bytes apart.
void copy_items(const std::byte* from, std::size_t from_step, std::byte* to, std::size_t to_step,
                std::size_t size, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(to + i * to_step, from + i * from_step, size);
  }
}

}  // namespace

AttributeLayout checked_attributes(const std::vector<Attribute>& attributes) {
  return AttributeLayout(AttributeColumns(attributes).attributes());
}

AttributeColumns columns_of(const AttributeLayout& layout, std::span<const std::byte> records) {
  if (layout.empty()) return {};
  const std::size_t step = layout.record_size();
  const std::size_t count = records.size() / step;
  AttributeColumns columns(layout.attributes(), count);
  for (const AttributeField& field : layout.fields()) {
    const std::size_t size = size_of(field.attribute);
    copy_items(records.data() + field.at, step, columns.bytes(field.attribute.name).data(), size,
               size, count);
  }
  return columns;
}

void check_columns(const AttributeColumns& columns, const AttributeLayout& told, std::size_t size,
                   const char* points) {
  for (const AttributeField& field : told.fields()) {
    const auto& have = columns.attributes();
    if (std::ranges::find(have, field.attribute) != have.end()) continue;
    throw InvalidArgument(
        fmt::format("{} come without attribute \"{}\" as the header tells it: give it with each "
                    "block, or leave it out of the header",
                    points, field.attribute.name));
  }
  for (const Attribute& attribute : columns.attributes()) {
    if (told.find(attribute.name) != nullptr) continue;
    throw InvalidArgument(
        fmt::format("{} come with attribute \"{}\", of which the header does not tell", points,
                    attribute.name));
  }
  if (told.empty() || columns.size() == size) return;
  throw InvalidArgument(
      fmt::format("a block has {} {}, but attributes of {}", size, points, columns.size()));
}

std::vector<std::byte> records_of(const AttributeColumns& columns, const AttributeLayout& layout,
                                  std::size_t first, std::size_t count) {
  const std::size_t step = layout.record_size();
  std::vector<std::byte> records(count * step);
  for (const AttributeField& field : layout.fields()) {
    const std::size_t size = size_of(field.attribute);
    const std::byte* const column = columns.bytes(field.attribute.name).data();
    copy_items(column + first * size, size, records.data() + field.at, step, size, count);
  }
  return records;
}

AttributeChoice attribute_choice(const std::vector<std::string>& names) {
  AttributeChoice choice;
  for (const std::string& name : names) {
    if (name == "all") choice.all = true;
    choice.names.push_back(attribute_name(name));
  }
  return choice;
}

std::vector<std::string> names_of(const AttributeChoice& choice) {
  return choice.all ? std::vector<std::string>{"all"} : choice.names;
}

InvalidArgument unknown_attribute(std::string_view name, std::span<const Attribute> attributes) {
  std::vector<std::string> known;
  for (const Attribute& attribute : attributes) known.push_back(attribute.name);
  return InvalidArgument(fmt::format("the points have no attribute \"{}\": {}", name,
                                     known.empty()
                                         ? std::string("they have none")
                                         : fmt::format("choose of {}", fmt::join(known, ", "))));
}

void refuse_unknown_names(const std::vector<std::string>& names, const AttributeLayout& offered) {
  for (const std::string& name : names) {
    if (name == "all" || offered.find(attribute_name(name)) != nullptr) continue;
    throw unknown_attribute(name, offered.attributes());
  }
}

}  // namespace spillway::stream

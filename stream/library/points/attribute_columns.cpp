#include <spillway/attribute_columns.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "formats/bytes/number_type.h"
#include "src/error.h"
#include "stream/library/choice_check.h"
#include "stream/library/points/attribute_records.h"

namespace spillway {
namespace {

using runtime::InvalidArgument;

/// No file has more, and sizes in bytes do not overflow.
constexpr std::size_t kMostElements = 1'000'000;

void check(const Attribute& attribute) {
  if (attribute.name.empty()) throw InvalidArgument("an attribute of points has no name");
  stream::check_choice(attribute.type, NumberType::kFloat64, "type of numbers");
  if (attribute.elements == 0 || attribute.elements > kMostElements) {
    throw InvalidArgument(fmt::format("attribute \"{}\" has {} elements: give 1 to {}",
                                      attribute.name, attribute.elements, kMostElements));
  }
  if (!std::isfinite(attribute.scale) || attribute.scale == 0 || !std::isfinite(attribute.offset)) {
    throw InvalidArgument(
        fmt::format("attribute \"{}\" has the scale {} and the offset {}: give finite ones, and a "
                    "scale that is not 0",
                    attribute.name, attribute.scale, attribute.offset));
  }
}

std::size_t record_size(const Attribute& attribute) {
  return attribute.elements * formats::size_of(attribute.type);
}

}  // namespace

const char* to_string(NumberType type) noexcept { return formats::name_of(type).data(); }

AttributeColumns::AttributeColumns(std::vector<Attribute> attributes, std::size_t points)
    : attributes_(std::move(attributes)), columns_(attributes_.size()) {
  std::set<std::string_view> names;
  for (const Attribute& attribute : attributes_) {
    check(attribute);
    if (names.insert(attribute.name).second) continue;
    throw InvalidArgument(
        fmt::format("two attributes of points are called \"{}\"", attribute.name));
  }
  resize(points);
}

std::size_t AttributeColumns::place_of(std::string_view name) const {
  const auto found = std::ranges::find(attributes_, name, &Attribute::name);
  if (found != attributes_.end()) {
    return static_cast<std::size_t>(found - attributes_.begin());
  }
  throw stream::unknown_attribute(name, attributes_);
}

void AttributeColumns::check_type(std::size_t place, NumberType type) const {
  const Attribute& attribute = attributes_[place];
  if (attribute.type == type) return;
  throw InvalidArgument(fmt::format("attribute \"{}\" has numbers of type {}, not {}",
                                    attribute.name, formats::name_of(attribute.type),
                                    formats::name_of(type)));
}

std::span<const std::byte> AttributeColumns::bytes(std::string_view name) const {
  return columns_[place_of(name)];
}

std::span<std::byte> AttributeColumns::bytes(std::string_view name) {
  return columns_[place_of(name)];
}

std::span<const std::byte> AttributeColumns::bytes(std::string_view name, NumberType type) const {
  const std::size_t place = place_of(name);
  check_type(place, type);
  return columns_[place];
}

std::span<std::byte> AttributeColumns::bytes(std::string_view name, NumberType type) {
  const std::size_t place = place_of(name);
  check_type(place, type);
  return columns_[place];
}

std::vector<double> AttributeColumns::meant(std::string_view name) const {
  const std::size_t place = place_of(name);
  const Attribute& attribute = attributes_[place];
  const std::vector<std::byte>& column = columns_[place];
  return formats::with_number_type(attribute.type, [&](auto number) {
    using T = decltype(number);
    std::vector<double> meant(column.size() / sizeof(T));
    for (std::size_t i = 0; i < meant.size(); ++i) {
      const auto stored = static_cast<double>(formats::load<T>(column.data() + i * sizeof(T)));
      meant[i] = stored * attribute.scale + attribute.offset;
    }
    return meant;
  });
}

void AttributeColumns::resize(std::size_t points) {
  for (std::size_t a = 0; a < attributes_.size(); ++a) {
    columns_[a].resize(points * record_size(attributes_[a]));
  }
  points_ = points;
}

void AttributeColumns::append(const AttributeColumns& more) {
  if (more.attributes_ != attributes_) {
    throw InvalidArgument("columns of other attributes cannot be appended");
  }
  for (std::size_t a = 0; a < columns_.size(); ++a) {
    columns_[a].insert(columns_[a].end(), more.columns_[a].begin(), more.columns_[a].end());
  }
  points_ += more.points_;
}

}  // namespace spillway

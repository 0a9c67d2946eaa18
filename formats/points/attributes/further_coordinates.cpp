#include "formats/points/attributes/further_coordinates.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "formats/bytes/bytes.h"

namespace spillway::formats {
namespace {

const AttributeField* find_number(const AttributeLayout& layout, const std::string& name) {
  const AttributeField* const field = layout.find(name);
  return field != nullptr && field->attribute.elements == 1 ? field : nullptr;
}

/// Integers from here on may have been others before they became doubles.
constexpr double kLeastRounded = 0x1p53;

double number_at(const std::byte* record, std::size_t i) {
  return load<double>(record + i * sizeof(double));
}

}  // namespace

std::string coordinate_name(int axis) { return fmt::format("x{}", axis + 1); }

std::string column_name(int column) { return fmt::format("column_{}", column + 1); }

const AttributeField* find_coordinate(const AttributeLayout& layout, int axis) {
  const AttributeField* const field = find_number(layout, coordinate_name(axis));
  return field != nullptr ? field : find_number(layout, column_name(axis));
}

AttributeLayout with_further_coordinates(const AttributeLayout& layout,
                                         const AttributeChoice& choice, int dimension) {
  if (further_axes(dimension) == 0) return chosen(layout, choice);
  std::vector<Attribute> carried;
  for (int axis = kOwnAxes; axis < dimension; ++axis) {
    const Attribute& source = find_coordinate(layout, axis)->attribute;
    carried.push_back({.name = source.name,
                       .type = NumberType::kFloat64,
                       .unit = source.unit,
                       .description = source.description});
  }
  const std::size_t coordinates = carried.size();
  const AttributeLayout others = chosen(layout, choice);
  for (const AttributeField& field : others.fields()) {
    const auto is_it = [&](const Attribute& coordinate) {
      return coordinate.name == field.attribute.name;
    };
    if (std::none_of(carried.begin(), carried.begin() + coordinates, is_it)) {
      carried.push_back(field.attribute);
    }
  }
  return AttributeLayout(std::move(carried));
}

AttributeLayout further_coordinates(int dimension) {
  std::vector<Attribute> coordinates;
  for (int axis = kOwnAxes; axis < dimension; ++axis) {
    coordinates.push_back({.name = coordinate_name(axis)});
  }
  return AttributeLayout(std::move(coordinates));
}

bool has_further_coordinates(const AttributeLayout& layout, int dimension) {
  const std::span<const AttributeField> fields = layout.fields();
  const auto count = static_cast<std::size_t>(further_axes(dimension));
  if (fields.size() < count) return false;
  return std::all_of(fields.begin(), fields.begin() + count, [](const AttributeField& field) {
    const Attribute& it = field.attribute;
    return it.type == NumberType::kFloat64 && it.elements == 1 && it.scale == 1 && it.offset == 0;
  });
}

AttributeLayout without_further_coordinates(const AttributeLayout& layout, int dimension) {
  std::vector<Attribute> attributes = layout.attributes();
  attributes.erase(attributes.begin(), attributes.begin() + further_axes(dimension));
  return AttributeLayout(std::move(attributes));
}

CoordinateCheck::CoordinateCheck(const AttributeLayout& source, int dimension) {
  for (int axis = kOwnAxes; axis < dimension; ++axis) {
    const AttributeField* const field = find_coordinate(source, axis);
    sources_.push_back(field != nullptr ? field->attribute
                                        : Attribute{.name = coordinate_name(axis)});
  }
}

int CoordinateCheck::bad_axis(const std::byte* record) const {
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const double number = number_at(record, i);
    const bool may_be_rounded = is_integer(sources_[i].type) && size_of(sources_[i].type) == 8;
    if (!std::isfinite(number) || (may_be_rounded && std::abs(number) >= kLeastRounded)) {
      return kOwnAxes + static_cast<int>(i);
    }
  }
  return 0;
}

std::string CoordinateCheck::text(int bad_axis, const std::byte* record) const {
  const auto i = static_cast<std::size_t>(bad_axis - kOwnAxes);
  const double number = number_at(record, i);
  return fmt::format("the coordinate {} ({}), which is {}", number, sources_[i].name,
                     std::isfinite(number) ? "2^53 or beyond, not exact" : "not finite");
}

}  // namespace spillway::formats

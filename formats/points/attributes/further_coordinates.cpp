#include "formats/points/attributes/further_coordinates.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"

namespace spillway::formats {
namespace {

const AttributeField* find_number(const AttributeLayout& layout, const std::string& name) {
  const AttributeField* const field = layout.find(name);
  return field != nullptr && field->attribute.elements == 1 ? field : nullptr;
}

/// Whether it is, or might be, the coordinate of some axis beyond z.
bool may_be_coordinate(const Attribute& attribute, int dimension) {
  for (int axis = kOwnAxes; axis < dimension; ++axis) {
    if (attribute.name == coordinate_name(axis) || attribute.name == column_name(axis)) return true;
  }
  return false;
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
    const AttributeField* const source = find_coordinate(layout, axis);
    Attribute coordinate{.name = coordinate_name(axis)};
    if (source != nullptr) {
      coordinate.name = source->attribute.name;
      coordinate.unit = source->attribute.unit;
      coordinate.description = source->attribute.description;
    }
    carried.push_back(std::move(coordinate));
  }
  const AttributeLayout others = chosen(layout, choice);
  for (const AttributeField& field : others.fields()) {
    if (!may_be_coordinate(field.attribute, dimension)) carried.push_back(field.attribute);
  }
  return AttributeLayout(std::move(carried));
}

AttributeLayout with_names_of(const AttributeLayout& source, const AttributeLayout& layout,
                              int dimension) {
  if (further_axes(dimension) == 0) return layout;
  std::vector<Attribute> attributes = layout.attributes();
  for (int axis = kOwnAxes; axis < dimension; ++axis) {
    const AttributeField* const own = find_coordinate(source, axis);
    if (own == nullptr) continue;
    attributes[static_cast<std::size_t>(axis - kOwnAxes)].name = own->attribute.name;
  }
  return AttributeLayout(std::move(attributes));
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

AttributeLayout chosen_beside_coordinates(const AttributeLayout& layout,
                                          const AttributeChoice& choice, int dimension) {
  if (further_axes(dimension) == 0) return chosen(layout, choice);
  std::vector<Attribute> attributes = layout.attributes();
  attributes.resize(static_cast<std::size_t>(further_axes(dimension)));
  const AttributeLayout others = chosen(without_further_coordinates(layout, dimension), choice);
  for (const AttributeField& field : others.fields()) attributes.push_back(field.attribute);
  return AttributeLayout(std::move(attributes));
}

AttributeLayout without_further_coordinates(const AttributeLayout& layout, int dimension) {
  if (further_axes(dimension) == 0) return layout;
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

std::optional<std::size_t> CoordinateCheck::bad_axis(const std::byte* record) const {
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Attribute& source = sources_[i];
    const double number = number_at(record, i);
    if (!std::isfinite(number)) return i;
    const bool may_be_rounded = is_integer(source.type) && size_of(source.type) == 8;
    const double integer = (number - source.offset) / source.scale;
    if (may_be_rounded && std::abs(integer) >= kLeastRounded) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> CoordinateCheck::first_bad(std::span<const std::byte> records,
                                                      std::size_t record_size) const {
  if (sources_.empty()) return std::nullopt;
  for (std::size_t i = 0; i < records.size() / record_size; ++i) {
    if (!is_point(&records[i * record_size])) return i;
  }
  return std::nullopt;
}

std::string CoordinateCheck::text(const std::byte* record) const {
  const std::size_t i = bad_axis(record).value_or(0);
  const double number = number_at(record, i);
  return fmt::format(
      "the coordinate {} ({}), which is {}", number, sources_[i].name,
      std::isfinite(number) ? "of an integer of 2^53 or beyond, not exact" : "not finite");
}

}  // namespace spillway::formats

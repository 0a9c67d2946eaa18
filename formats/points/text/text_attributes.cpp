#include "formats/points/text/text_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/bytes/line_reader.h"
#include "formats/points/attributes/attribute_names.h"

namespace spillway::formats {

TextAttributes::TextAttributes(const TextColumns& columns, std::string_view first_row,
                               const std::vector<std::string>& names)
    : separator_(columns.separator()), decimal_commas_(columns.decimal_commas()) {
  if (separator_ == Separator::kNone) return;
  const std::vector<std::string_view> fields = text_fields(first_row, separator_);
  std::vector<Attribute> attributes;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    double value = 0;
    if (columns.has_coordinate(i) || !read_decimal(fields[i], decimal_commas_, value)) continue;
    std::string name =
        i < names.size() ? attribute_name(names[i]) : fmt::format("column_{}", i + 1);
    const bool is_taken = std::ranges::find(columns_, name, &Column::name) != columns_.end();
    if (name.empty() || is_taken) name = fmt::format("column_{}", i + 1);
    columns_.push_back({i, name});
    attributes.push_back({.name = std::move(name)});
  }
  layout_ = AttributeLayout(std::move(attributes));
}

void TextAttributes::carry(const AttributeLayout& wanted) {
  targets_.clear();
  record_size_ = wanted.record_size();
  for (const AttributeField& field : wanted.fields()) {
    const auto column = std::ranges::find(columns_, field.attribute.name, &Column::name);
    if (column == columns_.end()) continue;
    targets_.push_back({column->number, field.attribute.type, field.attribute.scale,
                        field.attribute.offset, field.at});
  }
}

bool TextAttributes::read(const std::vector<std::string_view>& fields, const Target& target,
                          std::byte* record) const {
  double value = std::numeric_limits<double>::quiet_NaN();
  if (target.column < fields.size() && !fields[target.column].empty() &&
      !read_decimal(fields[target.column], decimal_commas_, value)) {
    return false;
  }
  const double number = (value - target.offset) / target.scale;
  const bool rounds = target.scale != 1 && is_integer(target.type);
  return store_number(target.type, record + target.at, rounds ? std::nearbyint(number) : number);
}

bool TextAttributes::append(std::string_view row, std::vector<std::byte>& records) {
  put_text_fields(row, separator_, fields_);
  const std::size_t before = records.size();
  records.resize(before + record_size_);
  for (const Target& target : targets_) {
    if (read(fields_, target, &records[before])) continue;
    records.resize(before);
    return false;
  }
  return true;
}

std::string TextAttributes::fault(std::string_view row) const {
  const std::vector<std::string_view> fields = text_fields(row, separator_);
  std::vector<std::byte> record(record_size_);
  for (const Target& target : targets_) {
    if (read(fields, target, record.data())) continue;
    const auto column = std::ranges::find(columns_, target.column, &Column::number);
    return fmt::format(
        "column {} (\"{}\") is not a number: {}, where the first row has one; correct it",
        target.column + 1, column->name,
        quoted(target.column < fields.size() ? fields[target.column] : std::string_view()));
  }
  return "";
}

}  // namespace spillway::formats

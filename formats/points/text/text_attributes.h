#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/text/text_columns.h"

namespace spillway::formats {

/// The columns of a text besides those of coordinates, as attributes: numbers of 64 bits.
class TextAttributes {
 public:
  TextAttributes() = default;  ///< of a text without such columns
  /// All columns in which the first row has a number. `names` has those of all columns, or none:
  /// then they are called "column_4", by their number.
  TextAttributes(const TextColumns& columns, std::string_view first_row,
                 const std::vector<std::string>& names);

  [[nodiscard]] const AttributeLayout& layout() const { return layout_; }

  /// From now on append() gives records of this layout.
  void carry(const AttributeLayout& wanted);
  [[nodiscard]] bool carries() const { return record_size_ > 0; }

  /// Appends the record of a row; numbers of empty or missing fields are NaN. Returns false, with
  /// nothing appended, if a field is no number, or none of the layout's.
  bool append(std::string_view row, std::vector<std::byte>& records);

  /// Why append() does not take this row, and what to do.
  [[nodiscard]] std::string fault(std::string_view row) const;

 private:
  struct Column {
    std::size_t number = 0;  ///< counted from 0
    std::string name;
  };
  struct Target {
    std::size_t column = 0;
    NumberType type = NumberType::kFloat64;
    double scale = 1;
    double offset = 0;
    std::size_t at = 0;
  };
  [[nodiscard]] bool read(const std::vector<std::string_view>& fields, const Target& target,
                          std::byte* record) const;

  Separator separator_ = Separator::kBlanks;
  bool decimal_commas_ = false;
  std::vector<Column> columns_;
  AttributeLayout layout_;
  std::vector<Target> targets_;
  std::size_t record_size_ = 0;
  std::vector<std::string_view> fields_;  // of the row
};

}  // namespace spillway::formats

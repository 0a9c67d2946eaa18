#pragma once

#include <cstddef>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/attributes/record_conversion.h"

namespace spillway::formats {

/// Makes records with some of the attributes of records with more.
class RecordSelection {
 public:
  RecordSelection() = default;
  /// `kept` has attributes of `all`, as they are there.
  RecordSelection(const AttributeLayout& all, const AttributeLayout& kept);

  /// Replaces the records of so many points or vertices.
  void apply(std::vector<std::byte>& records, std::size_t count) const;

 private:
  std::size_t from_size_ = 0;
  std::size_t to_size_ = 0;
  RecordConversion conversion_;
};

}  // namespace spillway::formats

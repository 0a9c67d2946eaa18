#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/attributes/record_conversion.h"

namespace spillway::formats {

/// LAS records as records of a layout of attributes. What LAS does not have is 0.
class LasRecordUnpacking {
 public:
  LasRecordUnpacking() = default;  ///< of no attributes
  LasRecordUnpacking(std::span<const AttributeField> fields, const AttributeLayout& layout)
      : conversion_(fields, layout.fields()), size_(layout.record_size()) {}

  /// Replaces `out` by the attributes of LAS records of that length.
  void unpack(std::span<const std::byte> records, std::size_t length,
              std::vector<std::byte>& out) const;

  [[nodiscard]] bool empty() const { return size_ == 0; }

 private:
  RecordConversion conversion_;
  std::size_t size_ = 0;  ///< of a record of the layout
};

}  // namespace spillway::formats

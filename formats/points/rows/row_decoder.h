#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/attributes/record_conversion.h"
#include "formats/points/common/point_reader.h"
#include "formats/points/rows/row_layout.h"

namespace spillway::formats {

/// Makes points of rows.
class RowDecoder {
 public:
  /// `file` is the name for messages. `skips_invalid`: rows that are no points are left out.
  RowDecoder(RowLayout layout, std::string file, bool skips_invalid)
      : layout_(std::move(layout)), file_(std::move(file)), skips_invalid_(skips_invalid) {
    choose_coordinates();
  }

  [[nodiscard]] const RowLayout& layout() const { return layout_; }

  /// From now on blocks have attributes of this layout.
  void carry(const AttributeLayout& wanted);

  /// Replaces `block` by the points in `rows`, which are whole, the first of which has the number
  /// `first`. The rows are of no use afterwards. Throws Failure for a coordinate that is not finite,
  /// or an integer that is no double. Safe for many threads at a time.
  void decode(std::span<std::byte> rows, std::uint64_t first, PointBlock& block) const;

 private:
  void choose_coordinates();
  /// Returns whether all are points. T: the type of all coordinates.
  template <typename T>
  bool decode_alike(const std::byte* rows, PointBlock& block) const;
  bool decode_any(const std::byte* rows, PointBlock& block) const;
  [[nodiscard]] bool is_point(const std::byte* row) const;
  [[noreturn]] void fail_at_first_invalid(const std::byte* rows, std::uint64_t first) const;

  RowLayout layout_;
  std::string file_;
  bool skips_invalid_;
  bool (RowDecoder::*decode_coordinates_)(const std::byte*, PointBlock&) const = nullptr;
  RecordConversion conversion_;
  std::size_t record_size_ = 0;
};

}  // namespace spillway::formats

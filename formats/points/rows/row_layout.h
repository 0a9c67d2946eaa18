#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "formats/bytes/number_type.h"
#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/attributes/unique_names.h"

namespace spillway::formats {

/// The place of a coordinate in "xyz", in any case; nothing for other names.
std::optional<int> coordinate_called(std::string_view name);

/// Where a file has coordinates and attributes in the rows of its points, which are all of one
/// size.
class RowLayout {
 public:
  struct Coordinate {
    std::size_t at = 0;
    NumberType type = NumberType::kFloat64;
  };
  /// Appends numbers: the coordinate of that name, if it is one and the first, else an attribute.
  /// `swap`: they are of the other byte order.
  void append(std::string_view name, NumberType type, std::size_t elements, bool swap);
  /// Appends numbers that are no coordinate, whatever their name.
  void append_attribute(std::string_view name, NumberType type, std::size_t elements, bool swap);
  /// Appends bytes that are nobody's.
  void pass_over(std::size_t bytes) { size_ += bytes; }

  /// Bytes of a row.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Whether there are x and y.
  [[nodiscard]] bool has_plane() const { return axes_[0].has_value() && axes_[1].has_value(); }
  /// 3, or 2 if there is no z.
  [[nodiscard]] int coordinates() const { return axes_[2] ? 3 : 2; }
  /// Of x, y and z, in this order; z only where there is one.
  [[nodiscard]] const Coordinate& coordinate(int axis) const { return *axes_[axis]; }
  [[nodiscard]] const std::vector<AttributeField>& attributes() const { return attributes_; }
  /// Turns numbers of the other byte order in whole rows.
  void make_native(std::span<std::byte> rows) const;

 private:
  /// Numbers that are of the other byte order.
  struct Swapped {
    std::size_t at = 0;
    std::size_t size = 0;   ///< of a number
    std::size_t count = 0;  ///< of numbers, one after the other
  };

  void append_bytes(std::size_t each, std::size_t elements, bool swap);

  std::size_t size_ = 0;
  std::array<std::optional<Coordinate>, 3> axes_;
  std::vector<AttributeField> attributes_;
  std::vector<Swapped> swapped_;
  UniqueNames names_;
};

}  // namespace spillway::formats

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/points/attributes/attribute_layout.h"
#include "formats/points/attributes/record_conversion.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/lattice.h"

namespace spillway::formats {

/// What a format without scales has for attributes: doubles of what is meant where there is a
/// scale, else the same numbers.
AttributeLayout without_scales(const AttributeLayout& layout);

/// Makes rows of points: coordinates as doubles, then attributes, without gaps.
class RowEncoder {
 public:
  /// `to` has the attributes of `from`, in types that hold them.
  RowEncoder(const std::optional<IntegerLattice>& lattice, int coordinates,
             const AttributeLayout& from, const AttributeLayout& to);

  /// Bytes of a row.
  [[nodiscard]] std::size_t row_size() const { return row_size_; }

  /// The rows of points and their records, until the next call.
  std::span<const std::byte> encode(std::span<const LatticePoint> points,
                                    std::span<const std::byte> records);

 private:
  std::optional<IntegerLattice> lattice_;
  std::size_t coordinates_;
  std::size_t record_size_;
  std::size_t row_size_;
  RecordConversion conversion_;
  std::vector<std::byte> rows_;
};

}  // namespace spillway::formats

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "formats/meshes/common/colour.h"
#include "formats/meshes/common/mesh.h"
#include "formats/points/attributes/record_conversion.h"

namespace spillway::formats {

/// Makes of the records of vertices those that a format has.
class VertexRecords {
 public:
  /// Throws Failure for records that the format does not hold, the first of which is of the vertex
  /// of that number.
  using Check = std::function<void(std::span<const std::byte> records, std::uint64_t first)>;

  /// `to` has attributes of `header`, in types that hold their numbers, or colours of 8 bits
  /// instead of 16: these are the numbers themselves if the header says that they are bytes, else
  /// their upper 8 bits. No `check`: the format holds all records.
  VertexRecords(const MeshFileHeader& header, AttributeLayout to, Check check = nullptr);

  /// What the format has.
  [[nodiscard]] const AttributeLayout& layout() const { return to_; }
  /// Bytes of a record of it.
  [[nodiscard]] std::size_t size() const { return to_.record_size(); }

  /// The records as the format has them, until the next call. The first is of the vertex `first`.
  std::span<const std::byte> convert(std::span<const std::byte> records, std::uint64_t first);

 private:
  /// Leaves the upper 8 bits of colours, where these are what the format has of them.
  std::span<const std::byte> with_upper_bits(std::span<const std::byte> records);

  AttributeLayout from_;
  AttributeLayout to_;
  Check check_;
  std::optional<ColourFields> halved_;  ///< colours of which the upper bits are wanted
  RecordConversion conversion_;
  std::vector<std::byte> changed_;
  std::vector<std::byte> converted_;
};

}  // namespace spillway::formats

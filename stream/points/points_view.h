#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/points/attributes/further_coordinates.h"
#include "formats/points/common/point_reader.h"
#include "src/geometry/framed_point.h"

namespace spillway::stream {

/// Points side by side that lie elsewhere, with what each has besides its coordinates.
struct PointsView {
  std::span<const LatticePoint> points;
  std::span<const std::uint64_t> index{};   ///< one a point, or none
  std::span<const std::byte> attributes{};  ///< a record a point, all of one size, or none

  static PointsView of(const PointBlock& block) {
    return {block.points, block.index, block.attributes};
  }

  [[nodiscard]] std::size_t size() const { return points.size(); }
  [[nodiscard]] bool empty() const { return points.empty(); }
  /// Bytes of a point's record; 0 if there are none.
  [[nodiscard]] std::size_t record_size() const {
    return attributes.empty() ? 0 : attributes.size() / points.size();
  }
  /// All coordinates of a point.
  template <int D>
  [[nodiscard]] Point<D> coordinates(std::size_t i) const {
    const std::byte* const record = D > kOwnAxes ? &attributes[i * record_size()] : nullptr;
    return coordinates_of<D>(points[i], record);
  }
  [[nodiscard]] PointsView subview(std::size_t begin, std::size_t count) const {
    const std::size_t record = record_size();
    return {points.subspan(begin, count), index.empty() ? index : index.subspan(begin, count),
            attributes.subspan(begin * record, count * record)};
  }
  [[nodiscard]] PointsView first(std::size_t count) const { return subview(0, count); }
  [[nodiscard]] PointsView from(std::size_t begin) const { return subview(begin, size() - begin); }

  /// Appends them to those of a block.
  void append_to(PointBlock& block) const {
    block.points.insert(block.points.end(), points.begin(), points.end());
    block.index.insert(block.index.end(), index.begin(), index.end());
    block.attributes.insert(block.attributes.end(), attributes.begin(), attributes.end());
  }
};

}  // namespace spillway::stream

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/delaunay/common/working_memory.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/point.h"
#include "stream/points/points_view.h"

namespace spillway::stream {

/// The points of a tile, ready to be triangulated, in the order in which they were read.
template <int D>
struct TilePoints {
  std::vector<Point<D>> points;
  std::vector<double> heights;        ///< D = 2: z, one a point
  std::vector<std::uint64_t> index;   ///< one a point, or none
  std::vector<std::byte> attributes;  ///< a record a point, or none
  std::uint64_t left_out = 0;         ///< points equal to one of these that are not among them

  void resize(std::size_t count, bool with_index, std::size_t record_size) {
    resize(points, count);
    if constexpr (D == 2) resize(heights, count);
    if (with_index) resize(index, count);
    if (record_size > 0) resize(attributes, count * record_size);
  }
  /// Puts points, with all that they carry, into the places from `first` on.
  void set(std::size_t first, const PointsView& some) {
    for (std::size_t i = 0; i < some.size(); ++i) {
      points[first + i] = some.coordinates<D>(i);
      if constexpr (D == 2) heights[first + i] = some.points[i][2];
    }
    std::ranges::copy(some.index, index.data() + (some.index.empty() ? 0 : first));
    std::ranges::copy(some.attributes, attributes.data() + first * some.record_size());
  }

 private:
  template <typename T>
  static void resize(std::vector<T>& values, std::size_t count) {
    values.reserve(count);
    ask_for_huge_pages(values.data(), count * sizeof(T));
    values.resize(count);
  }
};

/// What a point takes in it, with an index, and with its number while it is triangulated; its
/// attributes come on top.
constexpr std::uint64_t kLoadedPointBytes =
    sizeof(LatticePoint) + sizeof(std::uint64_t) + sizeof(std::uint32_t);

}  // namespace spillway::stream

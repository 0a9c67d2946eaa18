#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/geometry/box.h"
#include "src/terrain/triangle_location.h"

namespace spillway::terrain {

/// A place, x and y in the coordinates of the triangles.
struct NumberedPlace {
  double x = 0;
  double y = 0;
  std::uint64_t number = 0;
};

struct NumberedHeight {
  std::uint64_t number = 0;
  double height = 0;
};

/// Places whose triangles are still to come, in a grid of cells of some places each.
class UnlocatedPoints {
 public:
  UnlocatedPoints() = default;
  explicit UnlocatedPoints(std::span<const NumberedPlace> places) { assign(places); }

  /// As if it were new, but for the memory it has.
  void assign(std::span<const NumberedPlace> places);

  /// Takes out the places in the closed triangle, and appends its heights there. They depend on the
  /// triangle alone, on its edges and corners on these alone (TrianglePlane). A triangle without
  /// area has none, for its neighbours have them.
  void take_located(const Triangle& triangle, std::vector<NumberedHeight>& heights);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Appends what has not been taken out.
  void append_to(std::vector<NumberedPlace>& places) const;

  /// What a place takes in it, in bytes.
  static constexpr std::size_t kPlaceBytes = sizeof(NumberedPlace) + sizeof(std::uint32_t);

 private:
  /// Places of a cell: from `begin` to before `end`.
  struct Cell {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
  };
  struct Columns {
    std::size_t first = 0;
    std::size_t last = 0;
  };

  [[nodiscard]] std::size_t row_of(double y) const;
  [[nodiscard]] std::size_t column_of(double x) const;
  [[nodiscard]] Columns columns_in_row(const Triangle& triangle, const Box<2>& box,
                                       std::size_t row) const;

  Box<2> box_;
  std::size_t rows_ = 1;
  std::size_t columns_ = 1;
  double cells_per_x_ = 0;
  double cells_per_y_ = 0;
  std::vector<Cell> cells_;
  std::vector<NumberedPlace> places_;  ///< cell by cell
  std::size_t size_ = 0;
};

}  // namespace spillway::terrain

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/framed_point.h"

namespace spillway::detail {

/// Where points lie: tight boxes around those of each cell of a grid in which some lie. The cells
/// are as small as they can be so that there are not too many, and become larger as points come. In
/// which order these come makes no difference, but for those that come first.
class CellSketch {
 public:
  /// Only the first `dimension` axes count.
  CellSketch(int dimension, std::size_t most_cells)
      : dimension_(dimension), most_cells_(std::max(most_cells, kFewestCells)) {}

  void add(std::span<const LatticePoint> points);
  /// Adds all that another sketch has. A box of it may reach into several cells here.
  void add(const CellSketch& other);
  /// Adds a box that holds points of which no more is known.
  void add(const Box<3>& box);

  /// How many boxes there are; and the boxes, neighbours after each other.
  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  template <int D>
  [[nodiscard]] std::vector<Box<D>> boxes() const;

  /// What a box takes in memory, about.
  static constexpr std::size_t kBoxBytes = 112;

 private:
  using Cell = std::array<std::int64_t, 3>;
  /// However large cells are, there may be one on each side of the origin on each axis.
  static constexpr std::size_t kFewestCells = 8;
  struct Hash {
    std::size_t operator()(const Cell& cell) const;
  };

  void begin(const Point<3>& origin, int exponent);
  void begin_at(const Box<3>& box);
  void set_exponent(int exponent);
  [[nodiscard]] bool reaches(const Point<3>& point) const;
  [[nodiscard]] Cell cell_of(const Point<3>& point) const;
  [[nodiscard]] double place(const Point<3>& point, int axis) const {
    return point[axis] * scale_ - scaled_origin_[axis];
  }
  void coarsen();

  int dimension_;
  std::size_t most_cells_;
  Point<3> origin_{};
  int exponent_ = 0;  ///< of two, of the side of a cell
  double scale_ = 1;  ///< that power's reciprocal
  Point<3> scaled_origin_{};
  bool begun_ = false;
  std::unordered_map<Cell, Box<3>, Hash> cells_;
};

}  // namespace spillway::detail

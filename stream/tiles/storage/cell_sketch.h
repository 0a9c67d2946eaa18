#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "src/delaunay/border/point_sketch.h"
#include "src/geometry/box.h"
#include "src/geometry/constructions/plate.h"
#include "src/geometry/framed_point.h"

namespace spillway::stream {

/// Where points lie: a tight box and a plate around those of each cell of a grid in which some lie.
/// The cells are as small as they can be so that there are not too many, and become larger as
/// points come, in whatever spans. All points are to be gathered, and then measured once more.
class CellSketch {
 public:
  CellSketch() = default;
  /// Only the first `dimension` axes count. Most points will lie in `box`.
  CellSketch(int dimension, std::size_t most_cells, const Box<3>& box);

  void gather(std::span<const LatticePoint> points);
  /// All that another sketch has, which has been measured. A box of it may reach into other cells.
  void gather(const CellSketch& other);
  /// Points of which no more is known than a box around them.
  void gather(const Box<3>& box);

  /// The same again, in any order, after all have been gathered.
  void measure(std::span<const LatticePoint> points);
  void measure(const CellSketch& other);
  void measure(const Box<3>& box);

  /// How many cells there are; and what is known of them, neighbours after each other.
  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  template <int D>
  [[nodiscard]] PointSketch<D> sketch() const;

  template <typename State>
  void state(State& state) {
    state(dimension_, most_cells_, origin_, exponent_, scale_, scaled_origin_, measuring_);
    std::vector<NumberedCell> cells = in_order();
    state(cells);
    if constexpr (State::kReads) {
      cells_.clear();
      for (const NumberedCell& cell : cells) cells_.emplace(cell.number, cell.cell);
    }
  }

  /// What a cell takes in memory, about.
  static constexpr std::size_t kCellBytes = 256;

 private:
  using Number = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Number& number) const;
  };
  struct Cell {
    Box<3> box{};
    double weight = 0;  ///< points, or boxes
    /// Sums of coordinates from the origin on, and of their products: xx, yy, zz, yz, zx, xy.
    std::array<double, 3> sum{};
    std::array<double, 6> products{};
    Plate<3> plate{};  ///< once it is measured

    void add(const Cell& other);
    void begin_plate(const Point<3>& origin, int dimension);
  };
  struct NumberedCell {
    Number number{};
    Cell cell{};
  };
  /// Of a table they come in any order.
  [[nodiscard]] std::vector<NumberedCell> in_order() const;

  /// However large cells are, there may be one on each side of the origin on each axis.
  static constexpr std::size_t kFewestCells = 8;

  void set_exponent(int exponent);
  [[nodiscard]] bool reaches(const Point<3>& point) const;
  [[nodiscard]] Number number_of(const Point<3>& point) const;
  [[nodiscard]] double place(const Point<3>& point, int axis) const {
    return point[axis] * scale_ - scaled_origin_[axis];
  }
  [[nodiscard]] Point<3> flat(const Point<3>& point) const;
  void coarsen();
  void begin_measuring();

  int dimension_ = 2;
  std::size_t most_cells_ = kFewestCells;
  Point<3> origin_{};
  int exponent_ = 0;  ///< of two, of the side of a cell
  double scale_ = 1;  ///< that power's reciprocal
  Point<3> scaled_origin_{};
  bool measuring_ = false;
  std::unordered_map<Number, Cell, Hash> cells_;
};

}  // namespace spillway::stream

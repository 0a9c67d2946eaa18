#pragma once
// The cells of a sorted stream: its table of them, and the proof that points keep to it.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/blocks/block_stream.h"
#include "formats/points/common/point_reader.h"

namespace spillway::formats {

/// Appends the content of a block of the table to `content`: at most kSppTableCells cells of points
/// with 2 or 3 coordinates, boxes in the stream's coordinates.
void append_cells(std::vector<std::byte>& content, std::span<const PointRegion> cells,
                  int coordinates);

/// Follows the cells of a sorted stream while it is read. Whatever does not fit is an Failure of the
/// stream that names the block's place.
class SppCells {
 public:
  /// `coordinates` of a point, 2 or 3. The stream must outlive it.
  SppCells(BlockStream& stream, int coordinates, bool on_lattice)
      : stream_(stream), coordinates_(coordinates), on_lattice_(on_lattice) {}

  /// Reads the table: `count` cells, in the blocks that follow. Memory grows as they come.
  void read_table(std::uint64_t count);

  /// Boxes are in the stream's coordinates.
  [[nodiscard]] const std::vector<PointRegion>& all() const { return cells_; }
  [[nodiscard]] std::uint64_t points() const { return points_; }

  /// The number of the cell that the next points belong to, and how many of them are still to come;
  /// 0 if all cells are complete.
  [[nodiscard]] std::size_t current() const { return current_; }
  [[nodiscard]] std::uint64_t left_of_current() const {
    return current_ < cells_.size() ? cells_[current_].count - came_ : 0;
  }

  /// Takes the number of the cell off the front of a block of `size` points, and counts these.
  /// `is_last` if the block is marked as the last one of its cell. Returns the number.
  std::uint64_t begin_block(std::uint32_t size, bool is_last);

  /// Checks that the block's points lie in its cell: their coordinates along one axis. `first` is
  /// the number of the first point.
  void check_inside(std::span<const double> column, int axis, std::uint64_t first) const;

  /// Checks that all cells are complete.
  void expect_end() const;

 private:
  void take_cells();

  BlockStream& stream_;
  int coordinates_;
  bool on_lattice_;
  std::vector<PointRegion> cells_;
  std::uint64_t points_ = 0;    ///< of all cells
  std::size_t block_cell_ = 0;  ///< of the block that was begun last
  std::size_t current_ = 0;     ///< the first cell that is not complete
  std::uint64_t came_ = 0;      ///< of its points
};

}  // namespace spillway::formats

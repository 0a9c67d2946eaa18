#include "formats/points/spp/spp_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "formats/blocks/columns.h"
#include "formats/bytes/bytes.h"
#include "formats/points/spp/spp_coordinates.h"
#include "formats/points/spp/spp_format.h"

namespace spillway::formats {

void append_cells(std::vector<std::byte>& content, std::span<const PointRegion> cells,
                  int coordinates) {
  const auto size = static_cast<std::uint32_t>(cells.size());
  const auto bytes = std::as_bytes(std::span(&size, 1));
  content.insert(content.end(), bytes.begin(), bytes.end());
  std::vector<double> column(cells.size());
  const auto append_corners = [&](Point<3> Box<3>::*corner, int axis) {
    std::ranges::transform(cells, column.begin(),
                           [&](const PointRegion& cell) { return (cell.box.*corner)[axis]; });
    append_column(content, column);
  };
  for (int axis = 0; axis < coordinates; ++axis) {
    append_corners(&Box<3>::lo, axis);
    append_corners(&Box<3>::hi, axis);
  }
  std::vector<std::uint64_t> counts(cells.size());
  std::ranges::transform(cells, counts.begin(), &PointRegion::count);
  append_column(content, counts);
}

void SppCells::read_table(std::uint64_t count) {
  if (count > kSppMostCells) stream_.fail("it claims to have more cells than any stream has");
  while (cells_.size() < count) {
    if (stream_.next() != kSppCellTable) {
      stream_.fail(fmt::format("the table has {} of {} cells", cells_.size(), count));
    }
    take_cells();
    if (cells_.size() > count) stream_.fail(fmt::format("the table has more than {} cells", count));
  }
}

void SppCells::take_cells() {
  const auto size = stream_.take<std::uint32_t>();
  if (size == 0 || size > kSppTableCells) stream_.fail("a block's number of cells is invalid");
  const std::size_t before = cells_.size();
  cells_.resize(before + size);
  const std::span<PointRegion> cells = std::span(cells_).subspan(before);
  ColumnReader columns(stream_.left(), stream_.where());
  std::vector<double> lo;
  std::vector<double> hi;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis < coordinates_) {
      columns.read(size, lo);
      columns.read(size, hi);
    } else {
      lo.assign(size, 0);
      hi.assign(size, 0);
    }
    for (std::size_t i = 0; i < size; ++i) {
      cells[i].box.lo[axis] = lo[i];
      cells[i].box.hi[axis] = hi[i];
    }
    const std::size_t invalid = std::min(first_invalid_coordinate(lo, on_lattice_),
                                         first_invalid_coordinate(hi, on_lattice_));
    const auto reversed = static_cast<std::size_t>(
        std::ranges::mismatch(lo, hi, std::ranges::less_equal()).in1 - lo.begin());
    if (const std::size_t wrong = std::min(invalid, reversed); wrong < size) {
      stream_.fail(fmt::format("the box of cell {} is invalid", before + wrong));
    }
  }
  std::vector<std::uint64_t> counts;
  columns.read(size, counts);
  columns.expect_end();
  for (std::size_t i = 0; i < size; ++i) {
    const std::uint64_t most = std::numeric_limits<std::int64_t>::max() - points_;
    if (counts[i] == 0 || counts[i] > most) {
      stream_.fail(fmt::format("cell {} cannot have {} points", before + i, counts[i]));
    }
    cells[i].count = counts[i];
    points_ += counts[i];
  }
}

std::uint64_t SppCells::begin_block(std::uint32_t size, bool is_last) {
  const auto number = stream_.take<std::uint32_t>();
  if (current_ == cells_.size()) stream_.fail("points come though all cells are complete");
  if (number != current_) {
    stream_.fail(
        fmt::format("points of cell {} come where those of cell {} are due", number, current_));
  }
  const std::uint64_t count = cells_[current_].count;
  came_ += size;
  if (came_ > count) {
    stream_.fail(fmt::format("more points come of cell {} than its {}", number, count));
  }
  if (is_last != (came_ == count)) {
    stream_.fail(is_last ? fmt::format("cell {} is marked as complete after {} of its {} points",
                                       number, came_, count)
                         : fmt::format("cell {} is not marked as complete after all of its {} "
                                       "points",
                                       number, count));
  }
  block_cell_ = number;
  if (is_last) {
    ++current_;
    came_ = 0;
  }
  return number;
}

void SppCells::check_inside(std::span<const double> column, int axis, std::uint64_t first) const {
  const double lo = cells_[block_cell_].box.lo[axis];
  const double hi = cells_[block_cell_].box.hi[axis];
  bool inside = true;  // without a branch, as nearly always all are
  for (const double value : column) inside &= value >= lo && value <= hi;
  if (inside) return;
  const auto outside =
      std::ranges::find_if(column, [&](double value) { return value < lo || value > hi; });
  stream_.fail(fmt::format(
      "coordinate {} of point {} is {}, and its cell {} has {} to {}", "xyz"[axis],
      first + static_cast<std::uint64_t>(outside - column.begin()), *outside, block_cell_, lo, hi));
}

void SppCells::expect_end() const {
  if (current_ == cells_.size()) return;
  stream_.fail(fmt::format("the stream ends, but cell {} of {} has {} of its {} points", current_,
                           cells_.size(), came_, cells_[current_].count));
}

}  // namespace spillway::formats

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/runtime/packing.h"
#include "src/terrain/line_squares.h"

namespace spillway::stream {

/// Pieces of contours that wait, on the disk beyond some memory, until the file of their square is
/// written.
class LinesBySquare {
 public:
  /// `scratch` must outlive it.
  LinesBySquare(double side, std::uint64_t memory, ScratchFolder& scratch)
      : side_(side), memory_(memory), scratch_(scratch) {}

  /// Cuts a line at the edges of squares and keeps the pieces. Throws InvalidArgument for too many
  /// squares.
  void add(std::span<const Point<2>> points, std::int64_t level);

  /// The squares that have some, from the south-west, row by row.
  [[nodiscard]] std::vector<GridSquare> squares() const;

  /// Calls take(points, level) with the pieces of a square, in the order in which they came.
  void for_each(GridSquare square,
                const std::function<void(std::span<const Point<2>>, std::int64_t)>& take) const;

  [[nodiscard]] std::uint64_t spilled_bytes() const { return file_ ? file_->size() : 0; }

 private:
  struct Batch {
    std::uint64_t offset = 0;
    std::size_t bytes = 0;
  };
  struct Pieces {
    std::vector<Batch> spilled;
    Packer latest;
  };

  void check(std::span<const Point<2>> points) const;
  void spill();

  const double side_;
  const std::uint64_t memory_;
  ScratchFolder& scratch_;
  std::map<GridSquare, Pieces> squares_;
  std::uint64_t in_memory_ = 0;  ///< bytes
  std::unique_ptr<ScratchFile> file_;
};

}  // namespace spillway::stream

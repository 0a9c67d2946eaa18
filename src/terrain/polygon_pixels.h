#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "src/geometry/pixel_grid.h"
#include "src/geometry/point.h"
#include "src/terrain/triangle_pixels.h"

namespace spillway::terrain {

/// Columns of a row of pixels, from `begin` to before `end`.
struct ColumnRun {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

/// Which pixels of a raster lie in a polygon: those whose centre does, by the even-odd rule over
/// all rings. A centre on an edge belongs to what lies east of it, or north of a level one; so of
/// polygons that share their edges, each centre is in one.
class PolygonPixels {
 public:
  PolygonPixels(std::span<const std::vector<Point<2>>> rings, const PixelGrid& raster);
  /// Those that any of several has, or none of them: all pixels of the raster are looked at.
  PolygonPixels(std::span<const PolygonPixels> several, bool outside, const PixelGrid& raster);

  /// The smallest window with all of them; empty if there are none.
  [[nodiscard]] const PixelWindow& window() const { return window_; }
  /// Those of a row of the raster; ascending.
  [[nodiscard]] std::span<const ColumnRun> row(std::uint32_t row) const {
    if (row < window_.row_begin || row >= window_.row_end) return {};
    const std::size_t r = row - window_.row_begin;
    return std::span(runs_).subspan(first_run_[r], first_run_[r + 1] - first_run_[r]);
  }

  [[nodiscard]] bool has(std::uint32_t row, std::uint32_t column) const;
  /// What it takes.
  [[nodiscard]] std::uint64_t bytes() const {
    return runs_.size() * sizeof(ColumnRun) + first_run_.size() * sizeof(std::size_t);
  }

 private:
  void complete(const std::vector<std::uint32_t>& rows);

  PixelWindow window_;
  std::vector<ColumnRun> runs_;
  std::vector<std::size_t> first_run_;  ///< of each row of the window, and the end
};

}  // namespace spillway::terrain

#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "src/geometry/point.h"
#include "src/picture/picture.h"

namespace spillway::picture {

/// Thin smooth lines over a picture. A pixel keeps the strongest of its lines, so neither their
/// order nor drawing a line twice matters.
class LineLayer {
 public:
  LineLayer(std::uint32_t columns, std::uint32_t rows)
      : columns_(columns), rows_(rows), strength_(std::size_t{columns} * rows) {}

  /// Draws a line of about a pixel's width; strength from 0 to 1. Points are in pixels from the
  /// picture's upper left corner, and may lie anywhere. By any number of threads.
  void draw(Point<2> a, Point<2> b, float strength);

  /// From 0 to 255.
  [[nodiscard]] std::uint8_t strength(std::uint32_t column, std::uint32_t row) const {
    return strength_[std::size_t{row} * columns_ + column];
  }

  /// Lays the lines over a picture of the same size where that is not transparent; `opacity` is
  /// that of the strongest ones.
  void cover(Picture& picture, const Colour& colour, float opacity) const;

 private:
  void draw_pixel(std::uint32_t column, std::uint32_t row, double strength);

  std::uint32_t columns_;
  std::uint32_t rows_;
  std::vector<std::atomic<std::uint8_t>> strength_;
};

}  // namespace spillway::picture

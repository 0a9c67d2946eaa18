#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "src/picture/colour.h"

namespace spillway::picture {

/// Pixels in rows from the top: red, green, blue and opacity, a byte each. Opacity does not scale
/// the colours.
class Picture {
 public:
  static constexpr std::size_t kChannels = 4;

  /// All transparent.
  Picture(std::uint32_t columns, std::uint32_t rows)
      : columns_(columns), rows_(rows), bytes_(std::size_t{columns} * rows * kChannels) {}

  [[nodiscard]] std::uint32_t columns() const { return columns_; }
  [[nodiscard]] std::uint32_t rows() const { return rows_; }
  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }

  [[nodiscard]] Colour colour(std::uint32_t column, std::uint32_t row) const {
    const std::uint8_t* const pixel = &bytes_[offset(column, row)];
    return {static_cast<float>(pixel[0]) / 255, static_cast<float>(pixel[1]) / 255,
            static_cast<float>(pixel[2]) / 255};
  }
  /// From 0 to 255.
  [[nodiscard]] std::uint8_t opacity(std::uint32_t column, std::uint32_t row) const {
    return bytes_[offset(column, row) + 3];
  }

  /// Sets a pixel; opacity from 0 to 1.
  void set(std::uint32_t column, std::uint32_t row, const Colour& colour, float opacity) {
    std::uint8_t* const pixel = &bytes_[offset(column, row)];
    for (std::size_t k = 0; k < 3; ++k) pixel[k] = to_byte(colour[k]);
    pixel[3] = to_byte(opacity);
  }

  /// Lays a colour of an opacity over a pixel.
  void cover(std::uint32_t column, std::uint32_t row, const Colour& over, float opacity) {
    const float below = static_cast<float>(this->opacity(column, row)) / 255 * (1 - opacity);
    const float both = below + opacity;
    if (both > 0) set(column, row, mix(colour(column, row), over, opacity / both), both);
  }

  /// Adds transparent rows below.
  void add_rows(std::uint32_t count) {
    rows_ += count;
    bytes_.reserve(std::size_t{columns_} * rows_ * kChannels);
    bytes_.resize(std::size_t{columns_} * rows_ * kChannels);
  }

  /// Puts everything onto a background.
  void put_onto(const Colour& background) {
    for (std::uint32_t row = 0; row < rows_; ++row) {
      for (std::uint32_t column = 0; column < columns_; ++column) {
        const float share = static_cast<float>(opacity(column, row)) / 255;
        set(column, row, mix(background, colour(column, row), share), 1);
      }
    }
  }

 private:
  [[nodiscard]] std::size_t offset(std::uint32_t column, std::uint32_t row) const {
    return (std::size_t{row} * columns_ + column) * kChannels;
  }
  static std::uint8_t to_byte(float share) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0F, 1.0F) * 255));
  }

  std::uint32_t columns_;
  std::uint32_t rows_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace spillway::picture

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/picture/colour.h"
#include "src/picture/relief.h"

namespace spillway::picture {

/// Red, green and blue from 0 to 255.
using ByteColour = std::array<std::uint8_t, 3>;

inline Colour as_colour(const ByteColour& colour) {
  return {colour[0] / 255.0F, colour[1] / 255.0F, colour[2] / 255.0F};
}

/// Colours of a picture's pixels: each the mean of HeightPixels::kSamples x HeightPixels::kSamples
/// samples, as far as these have one.
class ColourPixels {
 public:
  ColourPixels(std::uint32_t columns, std::uint32_t rows)
      : columns_(columns), pixels_(std::size_t{columns} * rows) {}

  /// Adds a sample, by its place among the samples.
  void add(std::uint32_t sample_column, std::uint32_t sample_row, const ByteColour& colour) {
    constexpr std::uint32_t kSamples = HeightPixels::kSamples;
    Pixel& pixel =
        pixels_[std::size_t{sample_row / kSamples} * columns_ + sample_column / kSamples];
    for (std::size_t k = 0; k < colour.size(); ++k) pixel.sums[k] += colour[k];
    ++pixel.samples;
  }

  /// Grey where no sample has a colour.
  [[nodiscard]] Colour colour(std::size_t pixel) const {
    const auto& [sums, samples] = pixels_[pixel];
    if (samples == 0) return kGrey;
    const float all = 255.0F * samples;
    return {sums[0] / all, sums[1] / all, sums[2] / all};
  }

 private:
  static constexpr Colour kGrey = {0.6F, 0.6F, 0.6F};

  struct Pixel {
    std::array<std::uint16_t, 3> sums{};
    std::uint16_t samples = 0;
  };
  std::uint32_t columns_;
  std::vector<Pixel> pixels_;
};

}  // namespace spillway::picture

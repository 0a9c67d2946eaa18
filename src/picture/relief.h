#pragma once
// A shaded relief: heights as colours, slopes as light and shade.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "src/picture/picture.h"
#include "src/terrain/pixel_values.h"

namespace spillway::picture {

/// Heights of a picture's pixels: each the mean of kSamples x kSamples samples, as far as these
/// have a height. A single sample would make noise of whatever is finer than a pixel.
class HeightPixels {
 public:
  static constexpr std::uint32_t kSamples = 3;

  HeightPixels(std::uint32_t columns, std::uint32_t rows);

  /// Adds a sample, by its place among the samples.
  void add(std::uint32_t sample_column, std::uint32_t sample_row, float height);

  [[nodiscard]] std::uint32_t columns() const { return columns_; }
  [[nodiscard]] std::uint32_t rows() const { return rows_; }
  /// Samples that a pixel has.
  [[nodiscard]] std::uint8_t samples(std::size_t pixel) const { return samples_[pixel]; }
  /// The share of a pixel that has a height, from 0 to 1.
  [[nodiscard]] float coverage(std::size_t pixel) const {
    return static_cast<float>(samples_[pixel]) / (kSamples * kSamples);
  }
  /// Above base(); 0 where there is none.
  [[nodiscard]] float height(std::size_t pixel) const {
    return samples_[pixel] == 0 ? 0 : sums_[pixel] / static_cast<float>(samples_[pixel]);
  }
  /// The height of the first sample. Sums are taken above it, for they would lose digits otherwise.
  [[nodiscard]] float base() const { return base_; }
  [[nodiscard]] bool empty() const { return empty_; }

  /// The slope at a pixel (Horn's weights over its neighbours, the pixel itself standing in for
  /// those without a height), `side` being the length of a pixel's side.
  [[nodiscard]] Gradient gradient(std::uint32_t column, std::uint32_t row, double side) const;

 private:
  std::uint32_t columns_;
  std::uint32_t rows_;
  std::vector<float> sums_;
  std::vector<std::uint8_t> samples_;
  float base_ = 0;
  bool empty_ = true;
};

/// The factor of slopes that makes light and shade tell much: more than 1 for a plain, less where
/// heights have a smaller unit than x and y. `side` is the length of a pixel's side.
double visible_exaggeration(const HeightPixels& heights, double side);

/// Heights above base().
struct HeightRange {
  float lowest = 0;
  float highest = 0;
};

/// The 2nd and the 98th percentile of the heights; 0 and 0 if there are none.
HeightRange seen_range(const HeightPixels& heights);

struct ReliefStyle {
  double pixel_side = 1;    ///< in units of x and y
  double exaggeration = 1;  ///< of slopes
  Light light{};
  /// Of each pixel, how much of the light it does not get, from 0 to 255; empty: all get all of it.
  std::span<const std::uint8_t> shadows{};
};

/// The colour of a pixel in the light of a level place.
using ColourOfPixel = std::function<Colour(std::size_t pixel)>;

/// Colours by values such as heights: from the first colour for the range's lowest one to the last
/// one. `values` and what `colours` is a view of must outlive it.
ColourOfPixel colours_by(const HeightPixels& values, const HeightRange& range,
                         std::span<const Colour> colours);

/// Draws the relief. Pixels without a height are transparent.
Picture draw_relief(const HeightPixels& heights, const ColourOfPixel& colour,
                    const ReliefStyle& style);

}  // namespace spillway::picture

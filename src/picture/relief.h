#pragma once
// A shaded relief: heights as colours, slopes as light and shade.

#include <cstdint>
#include <optional>
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

struct ReliefStyle {
  double pixel_side = 1;                 ///< in units of x and y
  std::optional<double> exaggeration{};  ///< of slopes; nothing: such that they are seen
  Light light{};
};

/// A relief, and what it shows how.
struct Relief {
  Picture picture;
  double exaggeration = 1;
  float lowest = 0;  ///< the heights that have the first and the last colour of the table
  float highest = 0;
};

/// Draws the relief. Its colours range from the 2nd to the 98th percentile of the heights. Pixels
/// without a height are transparent.
Relief draw_relief(const HeightPixels& heights, const ReliefStyle& style);

}  // namespace spillway::picture

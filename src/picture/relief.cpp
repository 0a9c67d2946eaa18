#include "src/picture/relief.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/parallel/parallel.h"

namespace spillway::picture {
namespace {

/// What is left of a colour where there is no light, and how near to white it comes in full light.
constexpr float kDarkest = 0.28F;
constexpr float kLightest = 0.4F;

/// The part of the light that a full shadow takes.
constexpr double kShadow = 0.8;

/// Percentiles are taken of at most this many pixels.
constexpr std::size_t kLargestSample = 1'000'000;

/// The slope that this share of the pixels is below is brought into a range in which light and
/// shade tell much: a plain is exaggerated, and what has other units of height than of x and y is
/// made flatter.
constexpr double kShareOfSlopes = 0.6;
constexpr double kLeastSlope = 0.12;
constexpr double kLargestSlope = 0.8;

/// The first and the last colour are those of these percentiles: a few spikes do not matter.
constexpr double kLowShare = 0.02;
constexpr double kHighShare = 0.98;

constexpr std::size_t kRowsAtATime = 16;

/// The value that a share of the values is below; the values are left in another order.
float percentile(std::vector<float>& values, double share) {
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[place];
}

/// Calls `visit` for evenly chosen pixels that are all covered, or for all if there are none.
template <typename Visit>
void for_some_pixels(const HeightPixels& heights, const Visit& visit) {
  const std::size_t count = std::size_t{heights.columns()} * heights.rows();
  // An odd step does not run down columns.
  const std::size_t step = (count / kLargestSample) | 1U;
  constexpr std::uint8_t kAll = HeightPixels::kSamples * HeightPixels::kSamples;
  for (const std::uint8_t least : {kAll, std::uint8_t{1}}) {
    bool any = false;
    for (std::size_t i = 0; i < count; i += step) {
      if (heights.samples(i) < least) continue;
      any = true;
      visit(i);
    }
    if (any) return;
  }
}

double rounded_to_two_digits(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::round(value / unit) * unit;
}

Colour shaded(const Colour& colour, double brightness, double level_brightness) {
  constexpr double kLeast = 255e-6;  // light along the ground leaves level places dark
  const double relative = brightness / std::max(level_brightness, kLeast);
  if (relative <= 1) {
    return mix(kBlack, colour, kDarkest + (1 - kDarkest) * static_cast<float>(relative));
  }
  const double above = (brightness - level_brightness) / (255 - level_brightness);
  return mix(colour, kWhite, kLightest * static_cast<float>(above));
}

}  // namespace

HeightPixels::HeightPixels(std::uint32_t columns, std::uint32_t rows)
    : columns_(columns),
      rows_(rows),
      sums_(std::size_t{columns} * rows),
      samples_(std::size_t{columns} * rows) {}

void HeightPixels::add(std::uint32_t sample_column, std::uint32_t sample_row, float height) {
  if (empty_) base_ = height;
  empty_ = false;
  const std::size_t pixel =
      std::size_t{sample_row / kSamples} * columns_ + sample_column / kSamples;
  sums_[pixel] += height - base_;
  ++samples_[pixel];
}

Gradient HeightPixels::gradient(std::uint32_t column, std::uint32_t row, double side) const {
  const std::size_t centre = std::size_t{row} * columns_ + column;
  std::array<std::array<double, 3>, 3> z{};
  for (int r = -1; r <= 1; ++r) {
    for (int c = -1; c <= 1; ++c) {
      const std::int64_t near_row = std::int64_t{row} + r;
      const std::int64_t near_column = std::int64_t{column} + c;
      std::size_t pixel = centre;
      if (near_row >= 0 && near_row < rows_ && near_column >= 0 && near_column < columns_) {
        pixel =
            static_cast<std::size_t>(near_row) * columns_ + static_cast<std::size_t>(near_column);
        if (samples_[pixel] == 0) pixel = centre;
      }
      z[r + 1][c + 1] = height(pixel);
    }
  }
  const auto column_sum = [&z](int c) { return z[0][c] + 2 * z[1][c] + z[2][c]; };
  const auto row_sum = [&z](int r) { return z[r][0] + 2 * z[r][1] + z[r][2]; };
  return {(column_sum(2) - column_sum(0)) / (8 * side), (row_sum(0) - row_sum(2)) / (8 * side)};
}

double visible_exaggeration(const HeightPixels& heights, double side) {
  std::vector<float> slopes;
  for_some_pixels(heights, [&](std::size_t i) {
    const Gradient gradient =
        heights.gradient(static_cast<std::uint32_t>(i % heights.columns()),
                         static_cast<std::uint32_t>(i / heights.columns()), side);
    slopes.push_back(static_cast<float>(std::hypot(gradient[0], gradient[1])));
  });
  const double slope = slopes.empty() ? 0 : percentile(slopes, kShareOfSlopes);
  const double factor = std::clamp(slope, kLeastSlope, kLargestSlope) / slope;
  return slope > 0 && std::isfinite(factor) ? rounded_to_two_digits(factor) : 1;
}

HeightRange seen_range(const HeightPixels& heights) {
  std::vector<float> some;
  for_some_pixels(heights, [&](std::size_t i) { some.push_back(heights.height(i)); });
  if (some.empty()) return {};
  const float lowest = percentile(some, kLowShare);
  return {lowest, percentile(some, kHighShare)};
}

ColourOfPixel colours_by(const HeightPixels& values, const HeightRange& range,
                         std::span<const Colour> colours) {
  return [&values, range, colours](std::size_t pixel) {
    const float way = range.highest - range.lowest;
    return colour_at(colours, way > 0 ? (values.height(pixel) - range.lowest) / way : 0.5);
  };
}

Picture draw_relief(const HeightPixels& heights, const ColourOfPixel& colour,
                    const ReliefStyle& style) {
  const double exaggeration = style.exaggeration;
  const Point<3> light = direction_of(style.light);
  const double level = hillshade_of({0, 0}, light);
  Picture picture(heights.columns(), heights.rows());
  parallel_for(heights.rows(), kRowsAtATime, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (auto row = static_cast<std::uint32_t>(begin); row < end; ++row) {
      for (std::uint32_t column = 0; column < heights.columns(); ++column) {
        const std::size_t pixel = std::size_t{row} * heights.columns() + column;
        if (heights.samples(pixel) == 0) continue;
        const Gradient slope = heights.gradient(column, row, style.pixel_side);
        double brightness = hillshade_of({slope[0] * exaggeration, slope[1] * exaggeration}, light);
        if (!style.shadows.empty()) brightness *= 1 - kShadow * style.shadows[pixel] / 255;
        picture.set(column, row, shaded(colour(pixel), brightness, level), heights.coverage(pixel));
      }
    }
  });
  return picture;
}

}  // namespace spillway::picture

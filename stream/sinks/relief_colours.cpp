#include "stream/sinks/relief_colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>

#include "src/picture/categories.h"

namespace spillway::stream {
namespace {

/// Categories are numbers of 8 bits: larger ones count as the largest.
constexpr float kLargestCategory = 255;

std::uint8_t category_number(float number) {
  return static_cast<std::uint8_t>(std::lround(std::min(number, kLargestCategory)));
}

Category category_of(PictureColour colour, std::uint8_t number) {
  return colour == PictureColour::kClass ? category_of_class(number) : category_of_return(number);
}

}  // namespace

ReliefColours::ReliefColours(const PictureOptions& options, const HeightPixels& heights,
                             ReliefSamples& samples) {
  switch (options.colour) {
    case PictureColour::kHeight:
      take_range("height", "heights", heights, ramp_of(options));
      return;
    case PictureColour::kIntensity:
      values_.emplace(heights.columns(), heights.rows());
      samples.collect_numbers([this](std::uint32_t column, std::uint32_t row, const auto& numbers) {
        values_->add(column, row, numbers[0]);
      });
      take_range("intensity", "intensities", *values_, ramp_of(options));
      return;
    case PictureColour::kClass:
    case PictureColour::kReturn:
      colours_.emplace(heights.columns(), heights.rows());
      take_categories(options.colour, samples);
      return;
    case PictureColour::kRgb:
      colours_.emplace(heights.columns(), heights.rows());
      take_rgb(samples);
      return;
  }
}

void ReliefColours::take_range(const char* one, const char* many, const HeightPixels& values,
                               const Ramp& ramp) {
  const HeightRange range = seen_range(values);
  of_pixel_ = colours_by(values, range, ramp.colours);
  const std::string low = fmt::format("{:.6g}", values.base() + range.lowest);
  const std::string high = fmt::format("{:.6g}", values.base() + range.highest);
  legend_ = Legend{.title = one, .range = Legend::Range{ramp.colours, low, high}};
  description_ = fmt::format("{} from {} to {} in colours", many, low, high);
}

void ReliefColours::take_categories(PictureColour colour, ReliefSamples& samples) {
  std::array<ByteColour, 256> table{};
  for (unsigned i = 0; i < table.size(); ++i) {
    table[i] = category_of(colour, static_cast<std::uint8_t>(i)).colour;
  }
  std::bitset<256> there;
  samples.collect_numbers([&](std::uint32_t column, std::uint32_t row, const auto& numbers) {
    const std::uint8_t number = category_number(numbers[0]);
    there.set(number);
    colours_->add(column, row, table[number]);
  });
  Legend& legend = legend_.emplace();
  legend.title = colour == PictureColour::kClass ? "class" : "return";
  for (unsigned i = 0; i < table.size(); ++i) {
    if (!there[i]) continue;
    const Category category = category_of(colour, static_cast<std::uint8_t>(i));
    legend.entries.push_back({as_colour(category.colour), category.name});
  }
  description_ = fmt::format("{} kind{} of {} in colours", legend.entries.size(),
                             legend.entries.size() == 1 ? "" : "s", legend.title);
  of_pixel_ = [this](std::size_t pixel) { return colours_->colour(pixel); };
}

/// Where no number is above 255, they are of 8 bits, whatever their type; where none is above 1,
/// shares.
void ReliefColours::take_rgb(ReliefSamples& samples) {
  const float largest = samples.largest_number();
  const float most = largest > 255 ? 65535 : largest > 1 ? 255 : 1;
  samples.collect_numbers([&](std::uint32_t column, std::uint32_t row, const auto& numbers) {
    ByteColour colour{};
    for (std::size_t k = 0; k < colour.size(); ++k) {
      colour[k] = static_cast<std::uint8_t>(std::lround(std::min(numbers[k] / most, 1.0F) * 255));
    }
    colours_->add(column, row, colour);
  });
  description_ = "colours as the points have them";
  of_pixel_ = [this](std::size_t pixel) { return colours_->colour(pixel); };
}

}  // namespace spillway::stream

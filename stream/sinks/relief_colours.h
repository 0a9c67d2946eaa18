#pragma once

#include <optional>

#include "src/picture/colour_pixels.h"
#include "src/picture/legend.h"
#include "src/picture/relief.h"
#include "stream/sinks/relief_samples.h"

namespace spillway::stream {

/// The colours of a terrain's pixels, and what they stand for.
class ReliefColours {
 public:
  /// `samples` are taken from it. `heights` must outlive it.
  ReliefColours(const PictureOptions& options, const HeightPixels& heights, ReliefSamples& samples);

  [[nodiscard]] Colour colour(std::size_t pixel) const { return of_pixel_(pixel); }
  /// Nothing for colours as things look.
  [[nodiscard]] const std::optional<Legend>& legend() const { return legend_; }
  /// For people: "heights from 1 to 2".
  [[nodiscard]] const std::string& description() const { return description_; }

 private:
  void take_range(const char* one, const char* many, const HeightPixels& values, const Ramp& ramp);
  void take_categories(PictureColour colour, ReliefSamples& samples);
  void take_rgb(ReliefSamples& samples);

  std::optional<HeightPixels> values_;
  std::optional<ColourPixels> colours_;
  ColourOfPixel of_pixel_;
  std::optional<Legend> legend_;
  std::string description_;
};

}  // namespace spillway::stream

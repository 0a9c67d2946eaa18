#pragma once

#include <cstdint>
#include <span>

#include "src/rooms.h"

namespace spillway::generators {

/// Gradient noise in the plane (Perlin, "Improving Noise", SIGGRAPH 2002): smooth, of mean 0 and
/// standard deviation about 0.2, with hills about as wide as the wavelength. It is evaluated along
/// rows of whole coordinates, which takes about a nanosecond a value.
class Noise {
 public:
  /// Wavelength 2^log2_wavelength. The lattice of gradients is shifted by a random amount, so that
  /// the zeros of several octaves do not coincide.
  Noise(std::uint64_t seed, int log2_wavelength);

  /// Adds amplitude * noise(x + i, y) to values[i] for all i.
  void add_row(std::int64_t x, std::int64_t y, float amplitude, std::span<float> values) const;

 private:
  /// Along a row the contribution of one lattice column is linear in x.
  struct Line {
    float slope, value;
  };
  [[nodiscard]] Line line(std::uint64_t column, std::uint64_t row, float fraction) const;

  std::uint64_t key_, shift_x_, shift_y_;
  int log2_wavelength_;
};

}  // namespace spillway::generators

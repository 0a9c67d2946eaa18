#include "src/generators/noise.h"

#include <algorithm>

#include "src/generators/random.h"

namespace spillway::generators {
namespace {

/// Perlin's quintic: from 0 at 0 to 1 at 1 with two derivatives vanishing at both.
float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

float lerp(float a, float b, float t) { return a + (b - a) * t; }

}  // namespace

Noise::Noise(std::uint64_t seed, int log2_wavelength) : log2_wavelength_(log2_wavelength) {
  Random random(seed, static_cast<std::uint64_t>(log2_wavelength) * 4);
  key_ = random.bits();
  shift_x_ = random.bits() >> 16;  // leaves room to add coordinates
  shift_y_ = random.bits() >> 16;
}

Noise::Line Noise::line(std::uint64_t column, std::uint64_t row, float fraction) const {
  const auto gradient = [&](std::uint64_t r) {
    const std::uint64_t bits =
        mix_bits(key_ ^ (column * 0x9e3779b97f4a7c15ULL + r * 0xd1b54a32d192ed03ULL));
    const auto component = [](std::uint64_t b) {
      return static_cast<float>(static_cast<std::int16_t>(b & 0xffff)) * 0x1p-15F;
    };
    return std::pair{component(bits), component(bits >> 16)};
  };
  const auto [below_x, below_y] = gradient(row);
  const auto [above_x, above_y] = gradient(row + 1);
  const float weight = fade(fraction);
  return {lerp(below_x, above_x, weight),
          lerp(below_y * fraction, above_y * (fraction - 1), weight)};
}

void Noise::add_row(std::int64_t x, std::int64_t y, float amplitude,
                    std::span<float> values) const {
  const std::uint64_t wavelength = std::uint64_t{1} << log2_wavelength_;
  const float cell = 1.0F / static_cast<float>(wavelength);
  const std::uint64_t shifted_x = static_cast<std::uint64_t>(x) + shift_x_;
  const std::uint64_t shifted_y = static_cast<std::uint64_t>(y) + shift_y_;
  const std::uint64_t row = shifted_y >> log2_wavelength_;
  const float fraction_y = static_cast<float>(shifted_y & (wavelength - 1)) * cell;

  std::uint64_t column = shifted_x >> log2_wavelength_;
  auto first = static_cast<std::uint32_t>(shifted_x & (wavelength - 1));
  Line left = line(column, row, fraction_y);
  for (std::size_t begin = 0; begin < values.size();) {
    const Line right = line(++column, row, fraction_y);
    const std::size_t n = std::min<std::size_t>(wavelength - first, values.size() - begin);
    float* out = values.data() + begin;
    for (std::uint32_t i = 0; i < n; ++i) {
      const float t = static_cast<float>(static_cast<std::int32_t>(first + i)) * cell;
      const float from_left = left.slope * t + left.value;
      const float from_right = right.slope * (t - 1) + right.value;
      out[i] += amplitude * lerp(from_left, from_right, fade(t));
    }
    begin += n;
    first = 0;
    left = right;
  }
}

}  // namespace spillway::generators

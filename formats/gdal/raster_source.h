#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace spillway::formats {

/// What a raster tells of itself.
struct RasterFacts {
  std::string driver;  ///< GDAL's name of the format
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  /// What is stored, and so best read, together, in pixels.
  std::uint32_t block_columns = 0;
  std::uint32_t block_rows = 0;
  /// The place of a point c pixels from the left and r from the top: x is [0] + [1] c + [2] r, y is
  /// [3] + [4] c + [5] r.
  std::array<double, 6> place = {};
  std::string crs;                 ///< as Gdal takes it; empty: unknown
  std::vector<std::string> bands;  ///< their descriptions, or ""
  bool is_picture = false;         ///< its first band is of colours

  [[nodiscard]] std::array<double, 2> at(double column, double row) const {
    return {place[0] + place[1] * column + place[2] * row,
            place[3] + place[4] * column + place[5] * row};
  }
};

/// Some pixels of a raster.
struct RasterWindow {
  std::uint32_t column = 0;  ///< of the first one, from the left
  std::uint32_t row = 0;     ///< from the top
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;

  [[nodiscard]] std::size_t pixels() const { return std::size_t{columns} * rows; }
};

/// A raster being read, by one thread at a time.
class RasterSource {
 public:
  RasterSource() = default;
  virtual ~RasterSource() = default;
  RasterSource(const RasterSource&) = delete;
  RasterSource& operator=(const RasterSource&) = delete;

  [[nodiscard]] virtual const RasterFacts& facts() const = 0;

  /// Reads values of a band, counted from 0, row by row from the north, in the band's unit; NaN
  /// where there is no data. Throws Failure with GDAL's reason.
  virtual void read(std::size_t band, const RasterWindow& window, std::span<double> values) = 0;
};

}  // namespace spillway::formats

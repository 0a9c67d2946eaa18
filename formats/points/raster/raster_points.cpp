#include "formats/points/raster/raster_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/gdal/gdal.h"
#include "formats/points/rows/row_reader.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Values that are read at a time.
constexpr std::uint64_t kWindowValues = 65536;

/// The windows of a raster, block by block as they are stored.
class Windows {
 public:
  explicit Windows(const RasterFacts& facts)
      : facts_(facts),
        columns_(side(facts.block_columns, facts.columns, facts.bands.size())),
        rows_(side(facts.block_rows, facts.rows, facts.bands.size() * columns_)) {}

  /// False after the last one.
  bool next(RasterWindow& window) {
    if (block_row_ >= facts_.rows) return false;
    const std::uint32_t block_end_row = end(block_row_, facts_.block_rows, facts_.rows);
    const std::uint32_t block_end_column = end(block_column_, facts_.block_columns, facts_.columns);
    window = {column_, row_, end(column_, columns_, block_end_column) - column_,
              end(row_, rows_, block_end_row) - row_};
    column_ += window.columns;
    if (column_ < block_end_column) return true;
    column_ = block_column_;
    row_ += window.rows;
    if (row_ < block_end_row) return true;
    block_column_ = block_end_column;
    if (block_column_ >= facts_.columns) {
      block_column_ = 0;
      block_row_ = block_end_row;
    }
    column_ = block_column_;
    row_ = block_row_;
    return true;
  }

 private:
  static std::uint32_t end(std::uint32_t begin, std::uint32_t length, std::uint32_t last) {
    return length < last - begin ? begin + length : last;
  }
  /// Of a window, if each pixel along it has so many values.
  static std::uint32_t side(std::uint32_t block, std::uint32_t all, std::uint64_t values) {
    const std::uint64_t most = std::max<std::uint64_t>(kWindowValues / values, 1);
    return static_cast<std::uint32_t>(std::min<std::uint64_t>({block, all, most}));
  }

  const RasterFacts& facts_;
  std::uint32_t columns_;  // of a window
  std::uint32_t rows_;
  std::uint32_t block_column_ = 0;  // first pixel of the block
  std::uint32_t block_row_ = 0;
  std::uint32_t column_ = 0;  // first pixel of the next window
  std::uint32_t row_ = 0;
};

/// Pixels as rows: x, y, and the values of all bands.
class PixelRows : public RowSource {
 public:
  explicit PixelRows(std::unique_ptr<RasterSource> raster)
      : raster_(std::move(raster)), windows_(raster_->facts()) {}

  std::size_t read(std::span<std::byte> rows) override {
    const std::size_t bands = raster_->facts().bands.size();
    const std::size_t row_size = (2 + bands) * sizeof(double);
    for (std::byte* at = rows.data(); at != rows.data() + rows.size(); at += row_size) {
      if (next_ == window_.pixels() && !read_window()) return at - rows.data();
      const auto column = static_cast<double>(window_.column + next_ % window_.columns);
      const auto row = static_cast<double>(window_.row + next_ / window_.columns);
      const std::array<double, 2> place = raster_->facts().at(column + 0.5, row + 0.5);
      store(at, place[0]);
      store(at + sizeof(double), place[1]);
      for (std::size_t b = 0; b < bands; ++b) {
        store(at + (2 + b) * sizeof(double), values_[b * window_.pixels() + next_]);
      }
      ++next_;
    }
    return rows.size();
  }

 private:
  void go_to(std::uint64_t /*row*/) override {}

  bool read_window() {
    if (!windows_.next(window_)) return false;
    next_ = 0;
    const std::size_t bands = raster_->facts().bands.size();
    values_.resize(bands * window_.pixels());
    for (std::size_t b = 0; b < bands; ++b) {
      raster_->read(b, window_, std::span(values_).subspan(b * window_.pixels(), window_.pixels()));
    }
    return true;
  }

  std::unique_ptr<RasterSource> raster_;
  Windows windows_;
  RasterWindow window_;
  std::vector<double> values_;  // of the window, band by band
  std::size_t next_ = 0;        // pixel of the window
};

}  // namespace

std::unique_ptr<PointReader> open_raster_points(std::unique_ptr<InputBytes> source,
                                                const std::string& path) {
  if (path == "-" || !source->size()) {
    throw BadInput(source->name(), "a raster is read from a file, not from a pipe; save it first");
  }
  std::unique_ptr<RasterSource> raster = gdal().open_raster(path);
  const RasterFacts& facts = raster->facts();
  if (facts.is_picture) {
    throw BadInput(path, "the first band is of colours, so this is a picture, without heights");
  }
  RowFile file{.row = {}, .header = {}};
  for (const char* const axis : {"x", "y", "z"}) {
    file.row.append(axis, NumberType::kFloat64, 1, false);
  }
  for (std::size_t b = 1; b < facts.bands.size(); ++b) {
    const std::string& name = facts.bands[b];
    file.row.append_attribute(name.empty() ? fmt::format("band_{}", b + 1) : name,
                              NumberType::kFloat64, 1, false);
  }
  file.header.name = path;
  file.header.format = "raster";
  file.header.version = facts.driver;
  file.header.count = std::uint64_t{facts.columns} * facts.rows;
  file.header.crs = facts.crs;
  file.has_empty_rows = true;  // pixels without data
  file.has_fixed_size = false;
  file.rows = std::make_unique<PixelRows>(std::move(raster));
  file.source = std::move(source);
  return open_row_reader(std::move(file));
}

}  // namespace spillway::formats

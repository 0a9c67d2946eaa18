#include "stream/sinks/point_bands.h"

#include <algorithm>
#include <limits>

namespace spillway::stream {
namespace {

/// Heights of one pixel in memory: 2 MiB.
constexpr std::size_t kMostLatest = (std::size_t{2} << 20) / sizeof(double);

}  // namespace

void AscendingHeights::add(double z) {
  if (latest_.size() == kMostLatest) {
    if (!file_) file_ = scratch_.create("heights");
    file_->append(std::as_bytes(std::span(latest_)));
    on_disk_ += latest_.size();
    latest_.clear();
  }
  latest_.push_back(z);
}

double AscendingHeights::at(std::uint64_t rank) const {
  if (rank >= on_disk_) return latest_[rank - on_disk_];
  double z = 0;
  file_->read(rank * sizeof(z), std::as_writable_bytes(std::span(&z, 1)));
  return z;
}

void AscendingHeights::clear() {
  latest_.clear();
  file_.reset();
  on_disk_ = 0;
}

PointBands::PointBands(const DemSinkOptions& options, PixelPoints& points,
                       const std::optional<IntegerLattice>& lattice, ScratchFolder& scratch)
    : points_(points), lattice_(lattice), heights_(scratch) {
  auto percent = options.percentiles.begin();
  for (std::size_t b = 0; b < options.products.size(); ++b) {
    const DemProduct product = options.products[b];
    if (!traits_of(product).of_points) continue;
    const bool is_percentile = product == DemProduct::kPercentile;
    made_.push_back({product, b, is_percentile ? *percent++ : 0});
    keeps_heights_ = keeps_heights_ || is_percentile;
  }
}

void PointBands::make(std::uint64_t tile, std::span<float> bands) {
  for (const Band& band : made_) {
    std::ranges::fill(bands.subspan(band.band * PixelPoints::kTilePixels, PixelPoints::kTilePixels),
                      std::numeric_limits<float>::quiet_NaN());
  }
  std::uint64_t pixel = 0;
  points_.read(tile, [&](const PointInPixel& point) {
    if (point.pixel != pixel) put(std::exchange(pixel, point.pixel), bands);
    const double z = lattice_ ? lattice_->to_world(2, point.z) : point.z;
    statistics_.add(z);
    if (keeps_heights_) heights_.add(z);
  });
  put(pixel, bands);
}

/// Puts what has come, if anything, into a pixel.
void PointBands::put(std::uint64_t pixel, std::span<float> bands) {
  if (statistics_.count() == 0) return;
  for (const Band& band : made_) {
    bands[band.band * PixelPoints::kTilePixels + pixel % PixelPoints::kTilePixels] =
        static_cast<float>(value_of(band));
  }
  points_in_pixels_ += statistics_.count();
  ++pixels_with_points_;
  statistics_ = {};
  if (keeps_heights_) heights_.clear();
}

double PointBands::value_of(const Band& band) const {
  switch (band.product) {
    case DemProduct::kMin:
      return statistics_.lowest();
    case DemProduct::kMax:
      return statistics_.highest();
    case DemProduct::kMean:
      return statistics_.mean();
    case DemProduct::kStddev:
      return statistics_.deviation();
    case DemProduct::kPercentile: {
      const PercentilePlace place(band.percent, statistics_.count());
      const double z = heights_.at(place.rank);
      return place.share == 0 ? z : z + place.share * (heights_.at(place.rank + 1) - z);
    }
    default:
      return static_cast<double>(statistics_.count());
  }
}

}  // namespace spillway::stream

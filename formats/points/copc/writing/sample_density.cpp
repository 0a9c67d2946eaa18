#include "formats/points/copc/writing/sample_density.h"

#include <algorithm>

namespace spillway::formats {
namespace {

constexpr std::size_t kMostKept = std::size_t{1} << 16U;
/// So few cells that the points that are kept meet about all that all points meet.
constexpr unsigned kCoarse = 4;
constexpr unsigned kLeast = 5;

}  // namespace

void SampleDensity::add(std::span<const std::byte> records, std::size_t record_length) {
  const std::uint64_t count = records.size() / record_length;
  std::uint64_t i = (stride_ - seen_ % stride_) % stride_;
  while (i < count) {
    if (kept_.size() == kMostKept) {
      for (std::size_t k = 0; k < kMostKept / 2; ++k) kept_[k] = kept_[2 * k];
      kept_.resize(kMostKept / 2);
      stride_ *= 2;
      if ((seen_ + i) % stride_ != 0) {
        i += stride_ / 2;
        continue;
      }
    }
    kept_.push_back(load<std::array<std::int32_t, 3>>(&records[i * record_length]));
    i += stride_;
  }
  seen_ += count;
}

unsigned SampleDensity::sample_bits(const OctreeCube& cube, std::uint64_t most_points) const {
  const auto cells = [&](unsigned bits) {
    std::vector<std::size_t> met;
    met.reserve(kept_.size());
    for (const auto& point : kept_) {
      met.push_back(cube.sample_cell_of(cube.place_of(point), 0, bits));
    }
    std::ranges::sort(met);
    return static_cast<double>(std::unique(met.begin(), met.end()) - met.begin());
  };
  if (kept_.empty()) return OctreeCube::kFinestBits;
  double sample = cells(kLeast);
  const double growth = sample / cells(kCoarse);  // with twice the cells along each axis
  unsigned bits = kLeast;
  while (bits < OctreeCube::kFinestBits && sample * growth <= static_cast<double>(most_points)) {
    sample *= growth;
    ++bits;
  }
  return bits;
}

}  // namespace spillway::formats

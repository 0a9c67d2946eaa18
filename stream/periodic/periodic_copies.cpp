#include "stream/periodic/periodic_copies.h"

#include <cmath>
#include <cstddef>
#include <cstring>

namespace spillway::stream {

void PeriodicCopies::apply(PointBlock& block, bool counted) {
  std::uint64_t wrapped = 0;
  std::uint64_t rounded = 0;
  for (LatticePoint& point : block.points) {
    const Wrapping wrapping = torus_.wrap(point);
    wrapped += wrapping.moved ? 1 : 0;
    rounded += wrapping.rounded ? 1 : 0;
  }
  if (counted) {
    wrapped_ += wrapped;
    rounded_ += rounded;
  }
  if (domain_) append_copies(block);
}

void PeriodicCopies::append_copies(PointBlock& block) const {
  const std::size_t count = block.size();
  const std::size_t record_size = block.record_size();
  for (std::size_t i = 0; i < count; ++i) {
    const LatticePoint point = block.points[i];
    if (!domain_->has_copies(point)) continue;
    const auto x = domain_->copies_along(0, point[0]);
    const auto y = domain_->copies_along(1, point[1]);
    const auto z = domain_->copies_along(2, point[2]);
    for (int n = 1; n < x.count * y.count * z.count; ++n) {
      block.points.emplace_back(x.coordinates[n % x.count], y.coordinates[n / x.count % y.count],
                                z.coordinates[n / (x.count * y.count)]);
      if (!block.index.empty()) block.index.push_back(block.index[i]);
      if (record_size == 0) continue;
      block.attributes.resize(block.attributes.size() + record_size);
      std::memcpy(&block.attributes[block.attributes.size() - record_size],
                  &block.attributes[i * record_size], record_size);
    }
  }
}

std::uint64_t PeriodicCopies::with_copies(std::uint64_t points) const {
  if (!domain_) return points;
  double copies = 1;
  for (int k = 0; k < torus_.dimension(); ++k) {
    if (torus_.periodic(k)) copies *= 1 + 2 * domain_->margin(k) / torus_.period(k);
  }
  return static_cast<std::uint64_t>(std::ceil(static_cast<double>(points) * copies));
}

}  // namespace spillway::stream

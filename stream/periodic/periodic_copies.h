#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "formats/points/common/point_reader.h"
#include "src/geometry/periodic_domain.h"

namespace spillway::stream {

/// Brings points into a periodic box, and appends to each block copies of its points within a margin
/// around the box. A copy has the index and the attributes of its point.
class PeriodicCopies {
 public:
  /// Without a margin, until one is set. `torus` must outlive it.
  explicit PeriodicCopies(const Torus& torus) : torus_(torus) {}

  /// Of blocks from now on, whose points come once more.
  void begin(const PeriodicDomain& domain) {
    domain_.emplace(domain);
    wrapped_ = rounded_ = 0;
  }

  /// By any number of threads at once. `counted`: what becomes of the points is.
  void apply(PointBlock& block, bool counted = true);

  /// So many points with their copies, if they lie evenly.
  [[nodiscard]] std::uint64_t with_copies(std::uint64_t points) const;
  /// Points that were outside of the box, and those whose coordinates were rounded.
  [[nodiscard]] std::uint64_t wrapped() const { return wrapped_; }
  [[nodiscard]] std::uint64_t rounded() const { return rounded_; }

 private:
  void append_copies(PointBlock& block) const;

  const Torus& torus_;
  std::optional<PeriodicDomain> domain_;
  std::atomic<std::uint64_t> wrapped_ = 0;
  std::atomic<std::uint64_t> rounded_ = 0;
};

}  // namespace spillway::stream

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/framed_point.h"

namespace spillway::stream {

/// About every `stride`-th of points that come in several spans. Jittered: rows of grids and scan
/// lines have a period.
class PointSample {
 public:
  explicit PointSample(std::size_t stride) : stride_(stride) {}

  void add(std::span<const LatticePoint> points);

  [[nodiscard]] std::vector<LatticePoint> take() { return std::move(sample_); }

 private:
  std::size_t stride_;
  std::vector<LatticePoint> sample_;
  std::uint64_t next_ = 0;   ///< the next one to be taken
  std::uint64_t first_ = 0;  ///< of the next span
};

/// Whether points of that box lie nearly all over the extent, on its first `dimension` axes.
bool spans_extent(const Box<3>& box, const Box<3>& extent, int dimension);

/// Appends points that stand for those still to come: `more` times as many as there are, all over
/// the extent, but where points have come from. For all one knows, the others lie evenly there.
void append_expected_points(std::vector<LatticePoint>& sample, const Box<3>& seen,
                            const Box<3>& extent, int dimension, double more);

}  // namespace spillway::stream

#pragma once

#include <algorithm>
#include <mutex>

#include "src/geometry/box.h"
#include "src/geometry/lattice_check.h"
#include "stream/points/points_view.h"

namespace spillway::stream {

/// The box around points along the first D axes, as many threads see them.
template <int D>
class SeenExtent {
 public:
  void add(const PointsView& points) {
    Box<D> box;
    if constexpr (D > kOwnAxes) {
      for (std::size_t i = 0; i < points.size(); ++i) box.expand(points.coordinates<D>(i));
    } else {
      const Box<3> all = box_around(points.points);
      std::copy_n(all.lo.begin(), D, box.lo.begin());
      std::copy_n(all.hi.begin(), D, box.hi.begin());
    }
    const std::lock_guard lock(mutex_);
    box_.expand(box);
  }

  /// When all have been seen.
  [[nodiscard]] const Box<D>& box() const { return box_; }

  template <typename State>
  void state(State& state) {
    state(box_);
  }

 private:
  std::mutex mutex_;  ///< guards the next one
  Box<D> box_;
};

}  // namespace spillway::stream

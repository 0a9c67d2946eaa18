#pragma once

#include <mutex>

#include "formats/points/common/point_reader.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice_check.h"

namespace spillway::stream {

/// The box around points in x and y, as many threads see them.
class SeenExtent {
 public:
  void add(const PointBlock& points) {
    const Box<2> box = plane_of(box_around(points.points));
    const std::lock_guard lock(mutex_);
    box_.expand(box);
  }

  /// When all have been seen.
  [[nodiscard]] const Box<2>& box() const { return box_; }

  template <typename State>
  void state(State& state) {
    state(box_);
  }

 private:
  std::mutex mutex_;  ///< guards the next one
  Box<2> box_;
};

}  // namespace spillway::stream

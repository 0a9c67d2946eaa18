#pragma once

#include <vector>

#include "src/delaunay/border/run_boxes.h"
#include "src/geometry/constructions/plate.h"

namespace spillway::delaunay {

/// Where points lie, roughly: each of them lies in one of the lowest boxes, and in the plate of
/// that box.
template <int D>
struct PointSketch {
  RunBoxes<D> boxes;
  std::vector<Plate<D>> plates;  ///< by box of the lowest level

  [[nodiscard]] static constexpr std::size_t bytes_of(std::size_t boxes) {
    return boxes *
           (sizeof(Plate<D>) + sizeof(Box<D>) * RunBoxes<D>::kFanOut / (RunBoxes<D>::kFanOut - 1));
  }
};

}  // namespace spillway::delaunay

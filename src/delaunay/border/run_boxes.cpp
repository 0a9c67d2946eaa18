#include "src/delaunay/border/run_boxes.h"

#include <utility>

#include "src/geometry/dimensions.h"

namespace spillway::delaunay {
namespace {

/// Boxes around every `count` consecutive items.
template <int D, typename Item>
std::vector<Box<D>> boxes_around(std::span<const Item> items, std::size_t count) {
  std::vector<Box<D>> boxes((items.size() + count - 1) / count);
  for (std::size_t i = 0; i < items.size(); ++i) boxes[i / count].expand(items[i]);
  return boxes;
}

}  // namespace

template <int D>
RunBoxes<D>::RunBoxes(std::span<const Point<D>> points) {
  if (points.empty()) return;
  levels_.push_back(boxes_around<D>(points, kRun));
  add_levels();
}

template <int D>
RunBoxes<D>::RunBoxes(std::vector<Box<D>> boxes) {
  if (boxes.empty()) return;
  levels_.push_back(std::move(boxes));
  add_levels();
}

template <int D>
void RunBoxes<D>::add_levels() {
  while (levels_.back().size() > kFanOut) {
    std::vector<Box<D>> above = boxes_around<D>(std::span<const Box<D>>(levels_.back()), kFanOut);
    levels_.push_back(std::move(above));
  }
}

#define SPILLWAY_INSTANTIATE(D) template class RunBoxes<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay

#include "src/library/start_tree.h"

#include <algorithm>
#include <bit>

#include "src/geometry/box.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"

namespace spillway::library {
namespace {

/// Smaller parts are built by one thread.
constexpr std::size_t kSmallestTask = std::size_t{1} << 13;

}  // namespace

template <int D, class Index>
StartTree<D, Index>::StartTree(std::vector<StartPoint<D, Index>> sample) {
  const std::size_t leaves = std::bit_floor(sample.size());
  cuts_.resize(leaves);
  cells_.resize(leaves);
  build(1, sample);
}

template <int D, class Index>
void StartTree<D, Index>::build(std::size_t node, std::span<StartPoint<D, Index>> sample) {
  if (node >= cells_.size()) {
    cells_[node - cells_.size()] = sample[0].cell;
    return;
  }
  Box<D> box;
  for (const auto& start : sample) box.expand(start.point);
  const int axis = box.longest_axis();
  const auto less = [axis](const StartPoint<D, Index>& a, const StartPoint<D, Index>& b) {
    return a.point[axis] != b.point[axis] ? a.point[axis] < b.point[axis] : a.point < b.point;
  };
  const std::size_t half = sample.size() / 2;
  const auto middle = sample.begin() + static_cast<std::ptrdiff_t>(half);
  std::nth_element(sample.begin(), middle, sample.end(), less);
  cuts_[node] = {middle->point[axis], static_cast<std::uint32_t>(axis)};
  if (sample.size() < kSmallestTask) {
    build(2 * node, sample.first(half));
    build(2 * node + 1, sample.subspan(half));
    return;
  }
  TaskGroup group;
  group.run([=, this] { build(2 * node, sample.first(half)); });
  group.run([=, this] { build(2 * node + 1, sample.subspan(half)); });
  group.wait();
}

#define SPILLWAY_INSTANTIATE(D)              \
  template class StartTree<D, std::int32_t>; \
  template class StartTree<D, std::int64_t>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::library

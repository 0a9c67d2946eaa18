#include "tests/formats/points/copc/point_octree.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace spillway::test {
namespace {

using Place = PointOctree::Place;
using Numbers = std::vector<std::uint32_t>;

constexpr std::int32_t kDeepest = 10;
/// A node with so many keeps them all.
constexpr std::size_t kMostUndivided = 10'000;
/// Fewer stay in the node above.
constexpr std::size_t kFewest = 2'000;

/// The root's cube around the points, which halves kDeepest times.
PointOctree empty_octree(std::span<const Place> points) {
  constexpr std::int64_t kSteps = std::int64_t{1} << kDeepest;
  PointOctree tree;
  tree.first_corner = points[0];
  Place last = points[0];
  for (const Place& point : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      tree.first_corner[axis] = std::min(tree.first_corner[axis], point[axis]);
      last[axis] = std::max(last[axis], point[axis]);
    }
  }
  std::int64_t longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    longest = std::max(longest, std::int64_t{last[axis]} - tree.first_corner[axis] + 1);
  }
  tree.side = (longest + kSteps - 1) / kSteps * kSteps;
  return tree;
}

class Division {
 public:
  explicit Division(std::span<const Place> points)
      : points_(points), tree_(empty_octree(points)), taken_(kCells * kCells * kCells) {}

  PointOctree run() && {
    Numbers all(points_.size());
    std::iota(all.begin(), all.end(), 0U);
    divide({0, 0, 0, 0}, std::move(all));
    return std::move(tree_);
  }

 private:
  static constexpr std::size_t kCells = PointOctree::kCells;

  /// Cells of a cube, counted along all axes.
  struct Cells {
    std::array<std::int64_t, 3> lo;  ///< of the cube
    std::int64_t side;               ///< of the cube
    std::int64_t count;              ///< along each axis

    [[nodiscard]] std::size_t cell_of(const Place& point) const {
      std::int64_t cell = 0;
      for (std::size_t axis = 3; axis-- > 0;) {
        cell = cell * count + (point[axis] - lo[axis]) * count / side;
      }
      return static_cast<std::size_t>(cell);
    }
  };

  [[nodiscard]] Cells cells_of(const std::array<std::int32_t, 4>& key, std::int64_t count) const {
    Cells cells{.lo = {}, .side = tree_.side >> key[0], .count = count};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cells.lo[axis] = tree_.first_corner[axis] + key[axis + 1] * cells.side;
    }
    return cells;
  }

  void divide(const std::array<std::int32_t, 4>& key, Numbers numbers) {
    const std::size_t at = tree_.nodes.size();
    tree_.nodes.push_back({.key = key, .points = {}});
    if (numbers.size() <= kMostUndivided || key[0] == kDeepest) {
      tree_.nodes[at].points = std::move(numbers);
      return;
    }
    Numbers sample;
    std::array<Numbers, 8> below = split(key, numbers, sample);
    numbers = {};
    for (std::size_t octant = 0; octant < below.size(); ++octant) {
      Numbers& its = below[octant];
      if (its.size() < kFewest) {
        sample.insert(sample.end(), its.begin(), its.end());
        continue;
      }
      std::array<std::int32_t, 4> child{key[0] + 1};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        child[axis + 1] = 2 * key[axis + 1] + static_cast<std::int32_t>(octant >> axis & 1U);
      }
      divide(child, std::move(its));
    }
    std::sort(sample.begin(), sample.end());
    tree_.nodes[at].points = std::move(sample);
  }

  /// The first point of each cell goes to the sample, the others to the octants.
  std::array<Numbers, 8> split(const std::array<std::int32_t, 4>& key, const Numbers& numbers,
                               Numbers& sample) {
    const Cells cells = cells_of(key, kCells);
    const Cells octants = cells_of(key, 2);
    taken_.assign(taken_.size(), false);
    std::array<Numbers, 8> below;
    for (const std::uint32_t number : numbers) {
      const Place& point = points_[number];
      const std::size_t cell = cells.cell_of(point);
      (taken_[cell] ? below[octants.cell_of(point)] : sample).push_back(number);
      taken_[cell] = true;
    }
    return below;
  }

  std::span<const Place> points_;
  PointOctree tree_;
  std::vector<bool> taken_;  ///< cells of the node in hand
};

}  // namespace

PointOctree make_point_octree(std::span<const PointOctree::Place> points) {
  return Division(points).run();
}

}  // namespace spillway::test

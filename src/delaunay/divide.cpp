#include "src/delaunay/divide.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/hash.h"
#include "src/delaunay/kernel_common/hilbert_order.h"
#include "src/delaunay/schedule.h"
#include "src/error.h"
#include "src/parallel/parallel.h"

namespace spillway::detail {
namespace {

/// The median of the smallest sample lies within 2% of the true one, by rank, nearly always; that
/// of the largest within 0.5%, so that threads with one large part each finish together.
constexpr std::size_t kSmallestSample = 1'023;
constexpr std::size_t kLargestSample = 65'535;
constexpr std::size_t kPointsOfSample = 16;
/// Parts below this size are divided in the task that made them.
constexpr std::size_t kSmallestParallelPart = 1 << 14;
constexpr std::size_t kBoxGrain = 1 << 16;
constexpr std::size_t kSampleGrain = 1 << 13;

template <int D>
class Divider {
 public:
  Divider(std::span<Point<D>> points, std::span<VertexId> input_index, const DivideOptions& options)
      : points_(points), input_index_(input_index), options_(options) {}

  Part<D> make_part(VertexId begin, VertexId end) const {
    Part<D> part;
    part.begin = begin;
    part.end = end;
    std::vector<Box<D>> boxes(grain_count(part.size(), kBoxGrain));
    parallel_for(part.size(), kBoxGrain, [&](std::size_t g, std::size_t first, std::size_t last) {
      Box<D> box;  // in registers, as boxes[g] could not be
      for (std::size_t i = first; i < last; ++i) box.expand(points_[begin + i]);
      boxes[g] = box;
    });
    for (const Box<D>& box : boxes) part.box.expand(box);
    return part;
  }

  /// Divides `part` down to its leaves.
  void divide(Part<D>& part, std::size_t depth, Task& task) const {
    if (options_.stop.stop_requested()) throw Interrupted();
    task.kind = TaskKind::kDivide;
    task.points = part.size();
    if (part.size() <= options_.leaf_size || part.box.lo == part.box.hi) {
      const Stopwatch watch(task.seconds);
      sort_leaf(part);
      return;
    }
    {
      const Stopwatch watch(task.seconds);
      split(part, options_.children, depth, part.children);
    }
    task.children.resize(part.children.size());
    TaskGroup group;
    for (std::size_t c = 0; c < part.children.size(); ++c) {
      const auto work = [&, c] { divide(part.children[c], depth + 1, task.children[c]); };
      if (part.size() < kSmallestParallelPart) {
        work();
      } else {
        group.run(work);
      }
    }
    group.wait();
  }

 private:
  /// Appends to `parts` up to `count` parts that `part` falls into, by repeated cuts in two.
  void split(const Part<D>& part, unsigned count, std::size_t depth,
             std::vector<Part<D>>& parts) const {
    if (count == 1 || part.box.lo == part.box.hi) {
      parts.push_back(part);
      return;
    }
    const unsigned low_count = count / 2;
    const VertexId middle = cut(part, cut_axis(part.box, depth), low_count, count);
    split(make_part(part.begin, middle), low_count, depth, parts);
    split(make_part(middle, part.end), count - low_count, depth, parts);
  }

  [[nodiscard]] int cut_axis(const Box<D>& box, std::size_t depth) const {
    int axis = box.longest_axis();
    if (options_.scheme == Division::kCyclingAxis) axis = static_cast<int>(depth % D);
    if (options_.scheme == Division::kConstantAxis) axis = 0;
    return box.lo[axis] < box.hi[axis] ? axis : box.longest_axis();
  }

  /// Moves the points below a cut, about share/whole of all, to the front; returns where the others
  /// begin. Neither side is empty.
  [[nodiscard]] VertexId cut(const Part<D>& part, int axis, unsigned share, unsigned whole) const {
    const std::size_t stride = std::max<std::size_t>(
        1,
        part.size() / std::clamp(part.size() / kPointsOfSample, kSmallestSample, kLargestSample));
    std::vector<double> sample(part.size() / stride);
    parallel_for(
        sample.size(), kSampleGrain, [&](std::size_t, std::size_t first, std::size_t last) {
          for (std::size_t s = first; s < last; ++s) {
            const std::size_t i = part.begin + s * stride;
            sample[s] =
                points_[i + mix64(i) % stride][axis];  // jittered: rows of grids have a period
          }
        });
    const auto rank = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() * share / whole);
    std::nth_element(sample.begin(), rank, sample.end());
    const double value = *rank;
    // Points on the cut go up, unless nothing is below it.
    return value > part.box.lo[axis]
               ? partition(part, [=](const Point<D>& p) { return p[axis] < value; })
               : partition(part, [=](const Point<D>& p) { return p[axis] <= value; });
  }

  /// Large parts are partitioned in two halves at the same time; then what is above in the first
  /// one changes places with what is below in the second one.
  template <typename Below>
  VertexId partition(const Part<D>& part, const Below& below) const {
    if (part.size() < kSmallestParallelPart) return partition_range(part.begin, part.end, below);
    const VertexId half = part.begin + part.size() / 2;
    std::array<VertexId, 2> middle;
    parallel_for(2, 1, [&](std::size_t side, std::size_t, std::size_t) {
      middle[side] = side == 0 ? partition_range(part.begin, half, below)
                               : partition_range(half, part.end, below);
    });
    const VertexId above = half - middle[0];
    const VertexId below_count = middle[1] - half;
    const VertexId exchanged = std::min(above, below_count);
    parallel_for(exchanged, kBoxGrain, [&](std::size_t, std::size_t first, std::size_t last) {
      const auto exchange_range = [&](const auto& items) {
        std::swap_ranges(items.begin() + middle[0] + first, items.begin() + middle[0] + last,
                         items.begin() + (middle[1] - exchanged) + first);
      };
      exchange_range(points_);
      exchange_range(input_index_);
    });
    return middle[0] + below_count;
  }

  /// Finds the next ones that are on the wrong side a stretch at a time, without branches.
  template <typename Below>
  VertexId partition_range(VertexId low, VertexId high, const Below& below) const {
    constexpr VertexId kStretch = 128;
    std::array<std::uint8_t, kStretch> low_wrong, high_wrong;
    VertexId low_count = 0, high_count = 0;  // in these lists, still to be exchanged
    VertexId low_next = 0, high_next = 0;    // the first ones of them
    while (high - low >= 2 * kStretch) {
      if (low_count == 0) {
        low_next = 0;
        for (VertexId i = 0; i < kStretch; ++i) {
          low_wrong[low_count] = static_cast<std::uint8_t>(i);
          low_count += below(points_[low + i]) ? 0 : 1;
        }
      }
      if (high_count == 0) {
        high_next = 0;
        for (VertexId i = 0; i < kStretch; ++i) {
          high_wrong[high_count] = static_cast<std::uint8_t>(i);
          high_count += below(points_[high - 1 - i]) ? 1 : 0;
        }
      }
      const VertexId count = std::min(low_count, high_count);
      for (VertexId i = 0; i < count; ++i) {
        exchange(low + low_wrong[low_next + i], high - 1 - high_wrong[high_next + i]);
      }
      low_next += count;
      high_next += count;
      low_count -= count;
      high_count -= count;
      if (low_count == 0) low += kStretch;
      if (high_count == 0) high -= kStretch;
    }
    for (;;) {
      while (low < high && below(points_[low])) ++low;
      while (low < high && !below(points_[high - 1])) --high;
      if (low >= high) return low;
      exchange(low++, --high);
    }
  }

  void exchange(VertexId a, VertexId b) const {
    std::swap(points_[a], points_[b]);
    std::swap(input_index_[a], input_index_[b]);
  }

  void sort_leaf(const Part<D>& part) const {
    const auto points = points_.subspan(part.begin, part.size());
    const auto input_index = input_index_.subspan(part.begin, part.size());
    const std::vector<VertexId> order = hilbert_order<D>(points, part.box);
    // A base case is likely to follow, which in space needs memory for four numbers a point.
    constexpr std::size_t kBytesOfPoint =
        D == 3 ? 4 * sizeof(double) : sizeof(Point<D>) + sizeof(VertexId);
    const std::size_t bytes = (part.size() + 1) * kBytesOfPoint;
    BorrowedSlab memory(SlabUse::kPoints, bytes);
    auto* const old_points = static_cast<Point<D>*>(memory->reserve(bytes));
    auto* const old_index = reinterpret_cast<VertexId*>(old_points + part.size());
    std::copy(points.begin(), points.end(), old_points);
    std::copy(input_index.begin(), input_index.end(), old_index);
    for (std::size_t i = 0; i < order.size(); ++i) {
      points[i] = old_points[order[i]];
      input_index[i] = old_index[order[i]];
    }
  }

  std::span<Point<D>> points_;
  std::span<VertexId> input_index_;
  const DivideOptions& options_;
};

template <int D>
void number_lists(Part<D>& part, std::uint32_t& next) {
  for (Part<D>& child : part.children) number_lists(child, next);
  part.list = next++;
}

}  // namespace

template <int D>
Part<D> divide(std::span<Point<D>> points, std::span<VertexId> input_index,
               const DivideOptions& options, Task* task) {
  const Divider<D> divider(points, input_index, options);
  Part<D> root = divider.make_part(0, static_cast<VertexId>(points.size()));
  Task unused;
  divider.divide(root, 0, task == nullptr ? unused : *task);
  std::uint32_t next = 0;
  number_lists(root, next);
  return root;
}

template Part<2> divide<2>(std::span<Point<2>>, std::span<VertexId>, const DivideOptions&, Task*);
template Part<3> divide<3>(std::span<Point<3>>, std::span<VertexId>, const DivideOptions&, Task*);

}  // namespace spillway::detail

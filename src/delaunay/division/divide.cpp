#include "src/delaunay/division/divide.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>

#include "src/delaunay/common/hash.h"
#include "src/delaunay/common/schedule.h"
#include "src/delaunay/common/working_memory.h"
#include "src/delaunay/division/axis_rule.h"
#include "src/delaunay/division/least_border_rule.h"
#include "src/delaunay/kernel_common/hilbert_order.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"

namespace spillway::delaunay {
namespace {

/// The median of the smallest sample lies within 2% of the true one, by rank, nearly always; that
/// of the largest within 0.5%, so that threads with one large part each finish together.
constexpr std::size_t kSmallestSample = 1'023;
constexpr std::size_t kLargestSample = 65'535;
constexpr std::size_t kPointsOfSample = 16;
/// Halves share the sample of the whole. One is made anew when less than this part of those wanted
/// is left.
constexpr std::size_t kUsedUp = 3;
/// One of so many points of a leaf that is to be filled stays free, as samples err.
constexpr std::size_t kSpareShare = 24;
/// Parts below this size are divided in the task that made them.
constexpr std::size_t kSmallestParallelPart = 1 << 14;
constexpr std::size_t kBoxGrain = 1 << 16;
constexpr std::size_t kSampleGrain = 1 << 13;

/// A range of the points, and some of them, by which it is cut.
template <int D>
struct Piece {
  VertexId begin = 0, end = 0;
  std::span<Point<D>> sample{};

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// The rule of that scheme.
template <int D>
std::unique_ptr<CutRule<D>> rule_of(const DivideOptions& options) {
  if (options.scheme != Division::kLeastBorder) {
    return std::make_unique<AxisRule<D>>(options.scheme);
  }
  // Leaves that are to be filled, and more than two parts, need cuts at certain places.
  return std::make_unique<LeastBorderRule<D>>(
      LeastBorderOptions{.smallest_judged = options.smallest_judged,
                         .largest_undivided = options.largest_undivided,
                         .movable = !options.fill_leaves && options.children == 2});
}

template <int D>
class Divider {
 public:
  Divider(std::span<Point<D>> points, std::span<VertexId> input_index, const DivideOptions& options,
          const CutRule<D>& rule)
      : points_(points), input_index_(input_index), options_(options), rule_(rule) {}

  /// Divides a piece down to its leaves.
  Part<D> divide(const Piece<D>& piece, std::size_t depth, Task& task) const {
    if (options_.stop.stop_requested()) throw Interrupted();
    task.kind = TaskKind::kDivide;
    task.points = piece.size();
    Part<D> part;
    part.begin = piece.begin;
    part.end = piece.end;
    std::deque<std::vector<Point<D>>> samples;
    std::vector<Piece<D>> pieces;
    {
      const Stopwatch watch(task.seconds);
      if (piece.size() > options_.leaf_points) {
        split(piece, options_.children, depth, pieces, samples);
      }
      if (pieces.size() <= 1) {
        part.box = box_of(piece);
        sort_leaf(part);
        return part;
      }
    }
    part.children.resize(pieces.size());
    task.children.resize(pieces.size());
    TaskGroup group;
    for (std::size_t c = 0; c < pieces.size(); ++c) {
      const auto work = [&, c] {
        part.children[c] = divide(pieces[c], depth + 1, task.children[c]);
      };
      if (piece.size() < kSmallestParallelPart) {
        work();
      } else {
        group.run(work);
      }
    }
    group.wait();
    for (const Part<D>& child : part.children) part.box.expand(child.box);
    return part;
  }

 private:
  /// Appends up to `count` pieces that `piece` falls into, by repeated cuts in two. `samples` gets
  /// what is sampled for them.
  void split(Piece<D> piece, unsigned count, std::size_t depth, std::vector<Piece<D>>& pieces,
             std::deque<std::vector<Point<D>>>& samples) const {
    if (count > 1 && piece.size() > 1) {
      if (kUsedUp * piece.sample.size() < wanted_sample(piece.size())) {
        piece.sample = samples.emplace_back(sample_of(piece));
      }
      Box<D> box = box_around(piece.sample);
      // Where a sample has no extent, all points may be equal.
      if (box.lo == box.hi) box = box_of(piece);
      if (box.lo != box.hi) {
        const unsigned low_count = count / 2;
        const std::size_t whole = std::max<std::size_t>(count, leaves_of(piece));
        const std::optional<Cut> where = rule_.choose({.sample = piece.sample,
                                                       .box = box,
                                                       .share = {whole * low_count / count, whole},
                                                       .count = piece.size(),
                                                       .depth = depth});
        if (!where) {
          pieces.push_back(piece);
          return;
        }
        const auto [low, high] = cut(piece, *where);
        split(low, low_count, depth, pieces, samples);
        split(high, count - low_count, depth, pieces, samples);
        return;
      }
    }
    pieces.push_back(piece);
  }

  /// Into how many leaves a piece is to be divided; 1 where its halves are to be of equal size.
  [[nodiscard]] std::size_t leaves_of(const Piece<D>& piece) const {
    if (!options_.fill_leaves) return 1;
    const std::size_t filled =
        std::max<std::size_t>(1, options_.leaf_points - options_.leaf_points / kSpareShare);
    return (piece.size() + filled - 1) / filled;
  }

  static std::size_t wanted_sample(std::size_t points) {
    return std::min(points, std::clamp(points / kPointsOfSample, kSmallestSample, kLargestSample));
  }

  [[nodiscard]] std::vector<Point<D>> sample_of(const Piece<D>& piece) const {
    const std::size_t stride = piece.size() / wanted_sample(piece.size());
    std::vector<Point<D>> sample(piece.size() / stride);
    parallel_for(sample.size(), kSampleGrain,
                 [&](std::size_t, std::size_t first, std::size_t last) {
                   for (std::size_t s = first; s < last; ++s) {
                     const std::size_t i = piece.begin + s * stride;
                     sample[s] = points_[i + mix64(i) % stride];  // rows of grids have a period
                   }
                 });
    return sample;
  }

  static Box<D> box_around(std::span<const Point<D>> points) {
    Box<D> box;
    for (const Point<D>& p : points) box.expand(p);
    return box;
  }

  [[nodiscard]] Box<D> box_of(const Piece<D>& piece) const {
    std::vector<Box<D>> boxes(grain_count(piece.size(), kBoxGrain));
    parallel_for(piece.size(), kBoxGrain, [&](std::size_t g, std::size_t first, std::size_t last) {
      boxes[g] = box_around(points_.subspan(piece.begin + first, last - first));
    });
    Box<D> all;
    for (const Box<D>& box : boxes) all.expand(box);
    return all;
  }

  /// Moves the points below a cut to the front, and the sample likewise. Not all points are equal
  /// on the axis. Neither half is empty.
  [[nodiscard]] std::array<Piece<D>, 2> cut(const Piece<D>& piece, const Cut& where) const {
    const std::span<Point<D>> sample = piece.sample;
    const int axis = where.axis;
    const double value = where.value;
    const auto halves = [&](const auto& below) -> std::array<Piece<D>, 2> {
      const VertexId middle = partition(piece, below);
      const auto sampled = std::partition(sample.begin(), sample.end(), below) - sample.begin();
      return {{{piece.begin, middle, sample.first(static_cast<std::size_t>(sampled))},
               {middle, piece.end, sample.subspan(static_cast<std::size_t>(sampled))}}};
    };
    // Points on the cut go up, unless nothing is below it.
    const auto cut_below = halves([=](const Point<D>& p) { return p[axis] < value; });
    if (cut_below[0].size() > 0) return cut_below;
    return halves([=](const Point<D>& p) { return p[axis] <= value; });
  }

  /// Large parts are partitioned in two halves at the same time; then what is above in the first
  /// one changes places with what is below in the second one.
  template <typename Below>
  VertexId partition(const Piece<D>& piece, const Below& below) const {
    if (piece.size() < kSmallestParallelPart) {
      return partition_range(piece.begin, piece.end, below);
    }
    const VertexId half = piece.begin + static_cast<VertexId>(piece.size() / 2);
    std::array<VertexId, 2> middle;
    parallel_for(2, 1, [&](std::size_t side, std::size_t, std::size_t) {
      middle[side] = side == 0 ? partition_range(piece.begin, half, below)
                               : partition_range(half, piece.end, below);
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
    // A base case is likely to follow, which for D > 2 needs memory for D + 1 numbers a point.
    constexpr std::size_t kBytesOfPoint =
        D > 2 ? (D + 1) * sizeof(double) : sizeof(Point<D>) + sizeof(VertexId);
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
  const CutRule<D>& rule_;
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
  Task unused;
  const std::unique_ptr<CutRule<D>> rule = rule_of<D>(options);
  Part<D> root = Divider<D>(points, input_index, options, *rule)
                     .divide({.begin = 0, .end = static_cast<VertexId>(points.size())}, 0,
                             task == nullptr ? unused : *task);
  std::uint32_t next = 0;
  number_lists(root, next);
  return root;
}

#define SPILLWAY_INSTANTIATE(D) \
  template Part<D> divide<D>(std::span<Point<D>>, std::span<VertexId>, const DivideOptions&, Task*);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay

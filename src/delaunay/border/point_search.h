#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "src/delaunay/border/conflict_region.h"
#include "src/delaunay/border/conflict_region_batch.h"
#include "src/delaunay/border/run_boxes.h"
#include "src/delaunay/division/divide.h"
#include "src/geometry/point.h"

namespace spillway::delaunay {

/// The parts beside one part, with their points.
template <int D>
struct Siblings {
  std::span<const Part<D>* const> parts;
  std::span<const Point<D>> points;    ///< of which parts are ranges
  std::span<const RunBoxes<D>> boxes;  ///< of the points of leaves, by list
  /// How many boxes of runs one question may look at. A region that meets more of them, and none of
  /// the points looked at, counts as holding one. If 0, any that meets the box of a leaf does.
  std::size_t most_boxes = kMostBoxes;

  static constexpr std::size_t kMostBoxes = 1 << 14;
};

/// Asks whether points of siblings lie in regions. Remembers points that it found, as regions that
/// follow each other often hold the same ones.
template <int D>
class PointSearch {
 public:
  /// What `siblings` refer to must outlive it. All questions together may take so many `steps`, and
  /// some more for each that was answered by no: then boxes of leaves are all that is asked. A box
  /// is a step, a point some.
  explicit PointSearch(const Siblings<D>& siblings,
                       std::size_t steps = std::numeric_limits<std::size_t>::max())
      : siblings_(siblings), steps_allowed_(steps) {}

  /// False only if the region certainly holds no point of a sibling. The answer does not depend on
  /// earlier questions, as long as there are steps left.
  [[nodiscard]] bool may_hold_a_point(const ConflictRegion<D>& region);

  /// The bits of those regions `asked` for of which that is not false.
  [[nodiscard]] std::uint64_t may_hold_points(const ConflictRegionBatch<D>& regions,
                                              std::uint64_t asked);

  /// How many steps all questions have taken.
  [[nodiscard]] std::size_t steps() const { return steps_; }

 private:
  [[nodiscard]] bool in_part(const ConflictRegion<D>& region, const Part<D>& part);
  [[nodiscard]] bool in_boxes(const ConflictRegion<D>& region, const Part<D>& leaf,
                              std::size_t level, std::size_t begin);
  [[nodiscard]] bool in_run(const ConflictRegion<D>& region, std::size_t begin, std::size_t end);

  Siblings<D> siblings_;
  [[nodiscard]] bool may_ask() const {
    return steps_ < steps_earned_ || steps_ - steps_earned_ < steps_allowed_;
  }

  std::size_t steps_allowed_;
  std::size_t steps_earned_ = 0;  ///< by answers
  std::size_t steps_ = 0;
  std::size_t boxes_left_ = 0;  ///< of a question
  std::array<Point<D>, 4> found_{};
  std::size_t found_count_ = 0;  ///< ever
};

/// How many simplices are enough for asking_for_points_pays().
constexpr std::size_t kAskedSample = 256;

/// Whether asking for points pays, told by a sample of a part's simplices, whose corners are
/// positions of `points` or kInfiniteVertex: it does unless regions meet very many boxes, or most
/// of them hold a point, as those of points on a common sphere do.
template <int D>
bool asking_for_points_pays(std::span<const std::array<VertexId, D + 1>> sample,
                            std::span<const Point<D>> points, const Siblings<D>& siblings);

}  // namespace spillway::delaunay

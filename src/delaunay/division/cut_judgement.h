#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::delaunay {

/// A cut does not pay if more than this share of the points has simplices across it: they would be
/// triangulated twice.
inline constexpr double kLargestCrossing = 0.5;

/// A cut of a sample, and what it costs.
struct JudgedCut {
  int axis;
  std::size_t below;  ///< how many points of the sample lie below it
  double share;       ///< of the points' weights, of those that are corners of simplices across it
};

/// What cuts of a set would cost, by the triangulation of a sample of it: the points of simplices
/// across a cut are those of the borders on both sides, which are triangulated twice. (Funke,
/// Sanders, Winkler, "Load-Balancing for Parallel Delaunay Triangulations", Euro-Par 2019, cut the
/// graph of a sample's triangulation into parts of any shape; here all cuts are across an axis.)
template <int D>
class CutJudgement {
 public:
  /// Of few points: they are triangulated by one thread.
  explicit CutJudgement(const std::vector<Point<D>>& sample);

  /// Of some simplices over the points, which may be those of a larger triangulation that have all
  /// corners among these. A simplex is told by the numbers of its corners. A point counts as many
  /// times as its weight says.
  CutJudgement(std::span<const Point<D>> points, std::span<const double> weights,
               std::span<const std::array<VertexId, D + 1>> simplices);

  /// Whether there are simplices: the sample spans D dimensions. Otherwise nothing is to be asked.
  [[nodiscard]] bool known() const { return known_; }

  /// The best cut that has `below` points of the sample below it, or up to `room` more or fewer. It
  /// is across `axis`, and in the middle of the room, unless another one is better by a quarter.
  [[nodiscard]] JudgedCut best_cut(int axis, std::size_t below, std::size_t room) const;

  /// The share of a cut that has `below` points of the sample below it; 1 where that is none.
  [[nodiscard]] double share(int axis, std::size_t below) const {
    return below < crossing_[axis].size() ? crossing_[axis][below] / all_ : 1;
  }

  /// Whether a cut near the middle pays.
  [[nodiscard]] bool some_cut_pays() const;

 private:
  void count_crossing(std::span<const Point<D>> points, std::span<const double> weights,
                      std::span<const std::array<VertexId, D + 1>> simplices);

  bool known_ = false;
  double all_ = 0;  ///< the weights of all points
  /// By axis and number of points below a cut, the weights of those that have simplices across it;
  /// of all where there is no such cut, since coordinates are equal.
  std::array<std::vector<double>, D> crossing_;
};

}  // namespace spillway::delaunay

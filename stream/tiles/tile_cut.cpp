#include "stream/tiles/tile_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/delaunay/division/cut_judgement.h"
#include "src/delaunay/division/filled_share.h"
#include "stream/tiles/cuts/sample_mesh.h"

namespace spillway::detail {
namespace {

/// The smaller share is at least this one, if that can be.
constexpr double kLeastShare = 0.2;
/// What a share that is off a half costs, against segments on both sides.
constexpr double kImbalanceCost = 0.5;
/// What it costs each time that a side doubles its length beyond twice its width, and beyond what
/// is compact, besides: when points that nobody expects may come, and when none do.
constexpr double kLongCost = 0.3;
constexpr double kTooLongCost = 1;
constexpr double kTooLongAtEndCost = 3;
/// Of the capacity: what compact tiles have at least that a long one is cut into.
constexpr double kLeastCompactShare = 1.0 / 16;
/// Nothing is any better than what is longer than this.
constexpr double kLongest = 64;
/// Sampled values that are tried as cuts on each axis.
constexpr std::size_t kTriedSamples = 7;

/// What points with simplices across a cut of a hollow tile cost, as a share of all.
constexpr double kCrossingCost = 2;

/// Points that fill less of their box are hollow; a smaller sample does not tell.
constexpr double kHollow = 0.3;
constexpr std::size_t kLeastToldSample = 512;

/// So many of a sample, and such a share of it, at one place are no accident.
constexpr std::size_t kLeastHeavySamples = 4;
constexpr double kLeastHeavyShare = 0.25;

double above(double value) {
  return std::nextafter(value, std::numeric_limits<double>::infinity());
}

template <int D>
std::vector<Point<D>> mesh_points(std::span<const LatticePoint> sample) {
  std::vector<Point<D>> points;
  for (const LatticePoint& p : sample) points.push_back(mesh_point<D>(p));
  return points;
}

template <int D>
double filled_share_of(std::span<const LatticePoint> sample) {
  const std::vector<Point<D>> points = mesh_points<D>(sample);
  Box<D> box;
  for (const Point<D>& p : points) box.expand(p);
  return filled_share<D>(points, box);
}

template <int D>
bool some_cut_pays_in(std::span<const LatticePoint> sample) {
  const CutJudgement<D> judgement(judged_sample<D>(mesh_points<D>(sample)));
  return !judgement.known() || judgement.some_cut_pays();
}

/// Of a hollow tile, the share of the sample that has simplices across a cut; else nothing.
class Crossing {
 public:
  explicit Crossing(const CrowdedTile& tile) {
    if (!tile.hollow) return;
    if (tile.dimension == 2) {
      plane_.emplace(mesh_points<2>(tile.sample));
    } else {
      space_.emplace(mesh_points<3>(tile.sample));
    }
  }

  /// Of a cut with so many points of the sample below it.
  [[nodiscard]] double share(int axis, std::size_t below) const {
    if (plane_ && plane_->known()) return plane_->share(axis, below);
    return space_ && space_->known() ? space_->share(axis, below) : 0;
  }

 private:
  std::optional<CutJudgement<2>> plane_;
  std::optional<CutJudgement<3>> space_;
};

/// The cuts of one axis.
class Axis {
 public:
  Axis(const CrowdedTile& tile, int axis) : tile_(tile), axis_(axis) {
    for (const LatticePoint& p : tile.sample) values_.push_back(p[axis]);
    std::sort(values_.begin(), values_.end());
    for (const TileSegment& segment : tile.segments) {
      points_ += static_cast<double>(segment.points);
    }
    points_ += tile.weight * static_cast<double>(values_.size());
  }

  /// Values that are worth a look, each above the lowest coordinate.
  [[nodiscard]] std::vector<double> candidates() const {
    std::vector<double> values;
    const auto add = [&](double value) {
      if (value > tile_.box.lo[axis_] && value <= tile_.box.hi[axis_]) values.push_back(value);
    };
    for (const TileSegment& segment : tile_.segments) {
      add(segment.box.lo[axis_]);
      add(above(segment.box.hi[axis_]));
    }
    for (std::size_t i = 1; i <= kTriedSamples && !values_.empty(); ++i) {
      add(values_[values_.size() * i / (kTriedSamples + 1)]);
    }
    add(median());
    if (values.empty()) add(above(tile_.box.lo[axis_]));
    return values;
  }

  /// The share of all points that a cut leaves below.
  [[nodiscard]] double share(double value) const {
    double below = tile_.weight * static_cast<double>(sampled_below(value));
    for (const TileSegment& segment : tile_.segments) {
      below += static_cast<double>(segment.points) * share_below(segment.box, {axis_, value});
    }
    return below / points_;
  }

  /// How many points of the sample a cut leaves below.
  [[nodiscard]] std::size_t sampled_below(double value) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(values_, value) - values_.begin());
  }

  /// The share of all points that lies in segments on both sides.
  [[nodiscard]] double split_share(double value) const {
    double split = 0;
    for (const TileSegment& segment : tile_.segments) {
      if (!side_of(segment.box, {axis_, value})) split += static_cast<double>(segment.points);
    }
    return split / points_;
  }

 private:
  /// By bisection: enough for a candidate.
  [[nodiscard]] double median() const {
    double lo = tile_.box.lo[axis_];
    double hi = tile_.box.hi[axis_];
    for (int step = 0; step < 20; ++step) {
      const double middle = lo + (hi - lo) / 2;
      (share(middle) < 0.5 ? lo : hi) = middle;
    }
    return hi;
  }

  const CrowdedTile& tile_;
  const int axis_;
  std::vector<double> values_;  ///< of the sample, sorted
  double points_ = 0;
};

}  // namespace

double aspect_by_cuts(const Box<3>& box, const Box<3>& cell, int dimension) {
  double shortest = std::numeric_limits<double>::infinity();
  double longest = 0;
  for (int k = 0; k < dimension; ++k) {
    const bool cut = std::isfinite(cell.lo[k]) || std::isfinite(cell.hi[k]);
    if (cut) shortest = std::min(shortest, box.extent(k));
    longest = std::max(longest, box.extent(k));
  }
  if (longest == 0) return 1;
  return shortest > 0 ? longest / shortest : std::numeric_limits<double>::infinity();
}

bool too_long(double points, double aspect, std::size_t capacity) {
  const double parts = aspect / kMostAspect;
  return parts > 1 && points >= parts * kLeastCompactShare * static_cast<double>(capacity);
}

double share_below(const Box<3>& box, const TileCut& cut) {
  const double lo = box.lo[cut.axis];
  const double hi = box.hi[cut.axis];
  if (cut.value <= lo) return 0;
  return cut.value > hi ? 1 : (cut.value - lo) / (hi - lo);
}

Box<3> part_of(const Box<3>& box, const TileCut& cut, int side) {
  Box<3> part = box;
  if (side == 0) {
    const double below = std::nextafter(cut.value, -std::numeric_limits<double>::infinity());
    part.hi[cut.axis] = std::min(part.hi[cut.axis], below);
  } else {
    part.lo[cut.axis] = std::max(part.lo[cut.axis], cut.value);
  }
  return part.lo[cut.axis] <= part.hi[cut.axis] ? part : Box<3>{};
}

std::optional<int> side_of(const Box<3>& box, const TileCut& cut) {
  if (box.hi[cut.axis] < cut.value) return 0;
  if (box.lo[cut.axis] >= cut.value) return 1;
  return std::nullopt;
}

std::optional<LatticePoint> heavy_place(const CrowdedTile& tile) {
  std::vector<LatticePoint> points = tile.sample;
  for (LatticePoint& p : points) {
    for (int k = tile.dimension; k < 3; ++k) p[k] = 0;
  }
  std::sort(points.begin(), points.end());
  std::optional<LatticePoint> place;
  std::size_t most = kLeastHeavySamples - 1;
  for (auto at = points.begin(); at != points.end();) {
    const auto end = std::upper_bound(at, points.end(), *at);
    const auto count = static_cast<std::size_t>(end - at);
    if (count > most) {
      most = count;
      place = *at;
    }
    at = end;
  }
  const double least = kLeastHeavyShare * static_cast<double>(points.size());
  return static_cast<double>(most) >= least ? place : std::nullopt;
}

std::optional<TileCut> cut_beside(const Box<3>& box, const LatticePoint& place, int dimension) {
  for (int k = 0; k < dimension; ++k) {
    for (const double value : {place[k], above(place[k])}) {
      if (value > box.lo[k] && value <= box.hi[k]) return TileCut{k, value};
    }
  }
  return std::nullopt;
}

bool is_clearly_hollow(std::span<const LatticePoint> sample, int dimension) {
  if (sample.size() < kLeastToldSample) return false;
  return (dimension == 2 ? filled_share_of<2>(sample) : filled_share_of<3>(sample)) < kHollow;
}

bool some_cut_pays(std::span<const LatticePoint> sample, int dimension) {
  return dimension == 2 ? some_cut_pays_in<2>(sample) : some_cut_pays_in<3>(sample);
}

std::optional<TileCut> choose_cut(const CrowdedTile& tile) {
  Box<3> reach = tile.box;
  reach.expand(tile.expected);
  const double too_long_cost = tile.complete ? kTooLongAtEndCost : kTooLongCost;
  const Crossing crossing(tile);
  const auto shape_cost = [&](const TileCut& cut, int side) {
    if (tile.hollow) return 0.0;
    const double times = std::min(aspect(part_of(reach, cut, side), tile.dimension), kLongest);
    return kLongCost * std::max(0.0, std::log2(times / 2)) +
           too_long_cost * std::max(0.0, std::log2(times / kMostAspect));
  };
  std::optional<TileCut> best;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < tile.dimension; ++k) {
    if (tile.box.extent(k) == 0) continue;
    const Axis axis(tile, k);
    for (const double value : axis.candidates()) {
      const TileCut cut{k, value};
      const double uneven = std::abs(axis.share(value) - 0.5);
      const double too_uneven = std::max(0.0, uneven - (0.5 - kLeastShare));
      const double cost = axis.split_share(value) + kImbalanceCost * uneven + 10 * too_uneven +
                          shape_cost(cut, 0) + shape_cost(cut, 1) +
                          kCrossingCost * crossing.share(k, axis.sampled_below(value));
      if (cost >= least) continue;
      least = cost;
      best = cut;
    }
  }
  return best;
}

}  // namespace spillway::detail

#include "stream/tiles/cuts/tile_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/delaunay/division/cut_judgement.h"
#include "src/delaunay/division/cut_rule.h"
#include "src/delaunay/division/filled_share.h"
#include "src/geometry/dimensions.h"
#include "stream/tiles/cuts/sample_mesh.h"

namespace spillway::stream {
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

/// The share of a sample that has simplices across a cut.
class Crossing {
 public:
  Crossing(std::span<const Point<3>> sample, int dimension) {
    if (dimension == 3) {
      space_.emplace(std::vector<Point<3>>(sample.begin(), sample.end()));
      return;
    }
    std::vector<Point<2>> points;
    for (const Point<3>& p : sample) points.push_back({p[0], p[1]});
    plane_.emplace(points);
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
  Axis(const PointsToCut<3>& points, int axis) : points_(points), axis_(axis) {
    for (const Point<3>& p : points.sample) values_.push_back(p[axis]);
    std::sort(values_.begin(), values_.end());
    for (const CountedBox<3>& part : points.boxes) all_ += part.count;
    all_ += points.weight * static_cast<double>(values_.size());
  }

  /// Values that are worth a look, each above the lowest coordinate.
  [[nodiscard]] std::vector<double> candidates() const {
    std::vector<double> values;
    const auto add = [&](double value) {
      if (value > points_.box.lo[axis_] && value <= points_.box.hi[axis_]) values.push_back(value);
    };
    for (const CountedBox<3>& part : points_.boxes) {
      add(part.box.lo[axis_]);
      add(above(part.box.hi[axis_]));
    }
    for (std::size_t i = 1; i <= kTriedSamples && !values_.empty(); ++i) {
      add(values_[values_.size() * i / (kTriedSamples + 1)]);
    }
    add(median());
    if (values.empty()) add(above(points_.box.lo[axis_]));
    return values;
  }

  /// The share of all points that a cut leaves below.
  [[nodiscard]] double share(double value) const {
    double below = points_.weight * static_cast<double>(sampled_below(value));
    for (const CountedBox<3>& part : points_.boxes) {
      below += part.count * share_below(part.box, Cut{axis_, value});
    }
    return below / all_;
  }

  /// How many points of the sample a cut leaves below.
  [[nodiscard]] std::size_t sampled_below(double value) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(values_, value) - values_.begin());
  }

  /// The share of all points that lies in boxes on both sides.
  [[nodiscard]] double split_share(double value) const {
    double split = 0;
    for (const CountedBox<3>& part : points_.boxes) {
      if (!side_of(part.box, Cut{axis_, value})) split += part.count;
    }
    return split / all_;
  }

 private:
  /// By bisection: enough for a candidate.
  [[nodiscard]] double median() const {
    double lo = points_.box.lo[axis_];
    double hi = points_.box.hi[axis_];
    for (int step = 0; step < 20; ++step) {
      const double middle = lo + (hi - lo) / 2;
      (share(middle) < 0.5 ? lo : hi) = middle;
    }
    return hi;
  }

  const PointsToCut<3>& points_;
  const int axis_;
  std::vector<double> values_;  ///< of the sample, sorted
  double all_ = 0;              ///< points
};

/// Cuts a tile into shares that are not too uneven, so that few boxes lie on both sides; and into
/// sides that are compact, or, if it is hollow, so that few simplices cross the cut.
class CompactSidesRule final : public CutRule<3> {
 public:
  explicit CompactSidesRule(const CrowdedTile& tile) : tile_(tile) {}

  [[nodiscard]] std::optional<Cut> choose(const PointsToCut<3>& points) const override {
    std::optional<Crossing> crossing;
    if (tile_.hollow) crossing.emplace(points.sample, tile_.dimension);
    std::optional<Cut> best;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < tile_.dimension; ++k) {
      if (points.box.extent(k) == 0) continue;
      const Axis axis(points, k);
      for (const double value : axis.candidates()) {
        const Cut cut{k, value};
        const double uneven = std::abs(axis.share(value) - 0.5);
        const double too_uneven = std::max(0.0, uneven - (0.5 - kLeastShare));
        const double crossed = crossing ? crossing->share(k, axis.sampled_below(value)) : 0;
        const double cost = axis.split_share(value) + kImbalanceCost * uneven + 10 * too_uneven +
                            shape_cost(cut, 0) + shape_cost(cut, 1) + kCrossingCost * crossed;
        if (cost >= least) continue;
        least = cost;
        best = cut;
      }
    }
    return best;
  }

 private:
  [[nodiscard]] double shape_cost(const Cut& cut, int side) const {
    if (tile_.hollow) return 0;
    Box<3> reach = tile_.box;
    reach.expand(tile_.expected);
    const double too_long_cost = tile_.complete ? kTooLongAtEndCost : kTooLongCost;
    const double times = std::min(aspect(part_of(reach, cut, side), tile_.dimension), kLongest);
    return kLongCost * std::max(0.0, std::log2(times / 2)) +
           too_long_cost * std::max(0.0, std::log2(times / kMostAspect));
  }

  const CrowdedTile& tile_;
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

std::optional<Cut> cut_beside(const Box<3>& box, const LatticePoint& place, int dimension) {
  for (int k = 0; k < dimension; ++k) {
    for (const double value : {place[k], above(place[k])}) {
      if (value > box.lo[k] && value <= box.hi[k]) return Cut{k, value};
    }
  }
  return std::nullopt;
}

bool is_clearly_hollow(std::span<const LatticePoint> sample, int dimension) {
  if (sample.size() < kLeastToldSample) return false;
  return with_cut_dimension(dimension,
                            [&](auto d) { return filled_share_of<d>(sample) < kHollow; });
}

bool some_cut_pays(std::span<const LatticePoint> sample, int dimension) {
  return with_cut_dimension(dimension, [&](auto d) { return some_cut_pays_in<d>(sample); });
}

std::optional<Cut> choose_cut(const CrowdedTile& tile) {
  std::vector<Point<3>> sample;
  for (const LatticePoint& p : tile.sample) sample.emplace_back(p);
  std::vector<CountedBox<3>> boxes;
  for (const TileSegment& segment : tile.segments) {
    boxes.push_back({segment.box, static_cast<double>(segment.points)});
  }
  return CompactSidesRule(tile).choose(
      {.sample = sample, .weight = tile.weight, .boxes = boxes, .box = tile.box});
}

}  // namespace spillway::stream

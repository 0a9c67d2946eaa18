#include "stream/tiles/tile_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spillway::detail {
namespace {

/// An axis may be cut whose extent is at least this share of the longest one: then no half is
/// longer than four times its width.
constexpr double kLeastExtent = 0.5;
/// The smaller share is at least this one, if that can be.
constexpr double kLeastShare = 0.2;
/// What a share that is off a half costs, against segments on both sides.
constexpr double kImbalanceCost = 0.5;
/// Sampled values that are tried as cuts on each axis.
constexpr std::size_t kTriedSamples = 7;

double above(double value) {
  return std::nextafter(value, std::numeric_limits<double>::infinity());
}

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
    double below =
        tile_.weight * static_cast<double>(std::lower_bound(values_.begin(), values_.end(), value) -
                                           values_.begin());
    for (const TileSegment& segment : tile_.segments) {
      below += static_cast<double>(segment.points) * share_below(segment.box, {axis_, value});
    }
    return below / points_;
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

double share_below(const Box<3>& box, const TileCut& cut) {
  const double lo = box.lo[cut.axis];
  const double hi = box.hi[cut.axis];
  if (cut.value <= lo) return 0;
  return cut.value > hi ? 1 : (cut.value - lo) / (hi - lo);
}

std::optional<int> side_of(const Box<3>& box, const TileCut& cut) {
  if (box.hi[cut.axis] < cut.value) return 0;
  if (box.lo[cut.axis] >= cut.value) return 1;
  return std::nullopt;
}

std::optional<TileCut> choose_cut(const CrowdedTile& tile) {
  double longest = 0;
  for (int k = 0; k < tile.dimension; ++k) longest = std::max(longest, tile.box.extent(k));
  std::optional<TileCut> best;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < tile.dimension; ++k) {
    const double extent = tile.box.extent(k);
    if (extent == 0 || extent < kLeastExtent * longest) continue;
    const Axis axis(tile, k);
    for (const double value : axis.candidates()) {
      const double share = axis.share(value);
      const double uneven = std::abs(share - 0.5);
      const double too_uneven = std::max(0.0, uneven - (0.5 - kLeastShare));
      const double cost = axis.split_share(value) + kImbalanceCost * uneven + 10 * too_uneven +
                          (longest - extent) / longest * kImbalanceCost;
      if (cost >= least) continue;
      least = cost;
      best = {k, value};
    }
  }
  return best;
}

}  // namespace spillway::detail

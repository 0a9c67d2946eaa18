#include "src/geometry/margin_survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace spillway::geometry {
namespace {

/// So many points tell how densely they lie.
constexpr std::uint64_t kEnough = 200;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

/// Of points that lie evenly at random, the circumsphere of a Delaunay simplex has as much volume
/// as n points have on average with a probability of about exp(-n) n^(D-1). Few of those near the
/// sides, which are about N^((D-1)/D), have more than this.
double points_in_largest_sphere(std::uint64_t points, int dimension) {
  return 10.5 + std::log(static_cast<double>(points)) * (dimension - 1) / dimension;
}

/// Of the largest sphere near a side, in sides of the cube that has one point.
double largest_radius(std::uint64_t points, int dimension) {
  const double ball = dimension == 2 ? std::numbers::pi : 4 * std::numbers::pi / 3;
  return std::pow(points_in_largest_sphere(points, dimension) / ball, 1.0 / dimension);
}

}  // namespace

double margin_of_even_points(const Torus& torus, std::uint64_t points) {
  if (points < kEnough) return kUnknown;
  double volume = 1;
  for (int k = 0; k < torus.dimension(); ++k) volume *= torus.period(k);
  const double spacing = std::pow(volume / static_cast<double>(points), 1.0 / torus.dimension());
  return spacing * largest_radius(points, torus.dimension());
}

MarginSurvey::MarginSurvey(const Torus& torus)
    : torus_(torus),
      dimension_(torus.dimension()),
      cells_(dimension_ == 2 ? 512 : 64),
      counts_(dimension_ == 2 ? std::size_t(cells_) * cells_
                              : std::size_t(cells_) * cells_ * cells_) {
  for (int k = 0; k < dimension_; ++k) cells_per_unit_[k] = cells_ / torus_.period(k);
}

double wider_margin(double margin, const Torus& torus) {
  constexpr double kTimes = 1.6;
  const double wider = kTimes * margin;
  return 2 * wider < torus.shortest_period() ? wider : std::numeric_limits<double>::infinity();
}

double MarginSurvey::margin() const {
  if (points_ < kEnough) return kUnknown;
  return spacing_at_sides() * largest_radius(points_, dimension_);
}

/// Where points lie least densely, the side of a cube that has one. Where a cell at a side has too
/// few points to tell, the larger one around it is asked.
double MarginSurvey::spacing_at_sides() const {
  std::vector<std::uint64_t> counts(counts_.begin(), counts_.end());
  double volume = 1;
  for (int k = 0; k < dimension_; ++k) volume *= torus_.period(k) / cells_;
  // By cell of the level: whether a cell at a side in it is still to be told of.
  std::vector<bool> asked(counts.size());
  const auto is_at_side = [this](std::size_t cell, int cells) {
    for (int k = 0; k < dimension_; ++k, cell /= cells) {
      const std::size_t along = cell % cells;
      if (along == 0 || along + 1 == std::size_t(cells)) return true;
    }
    return false;
  };
  for (std::size_t c = 0; c < counts.size(); ++c) asked[c] = is_at_side(c, cells_);
  double spacing = 0;
  for (int cells = cells_;; cells /= 2) {
    bool all_told = true;
    for (std::size_t c = 0; c < counts.size(); ++c) {
      if (!asked[c]) continue;
      if (counts[c] < kEnough) {
        all_told = false;
        continue;
      }
      asked[c] = false;
      // As many as may well be there: by chance there are fewer in some cells.
      const auto count = static_cast<double>(counts[c]);
      const double each = volume / (count + 3.5 * std::sqrt(count));
      spacing = std::max(spacing, std::pow(each, 1.0 / dimension_));
    }
    if (all_told) return spacing;
    if (cells == 1) return kUnknown;
    // 2^D cells become one.
    std::vector<std::uint64_t> larger(counts.size() >> dimension_);
    std::vector<bool> still(larger.size());
    for (std::size_t c = 0; c < counts.size(); ++c) {
      std::size_t parent = 0;
      std::size_t rest = c;
      std::size_t place = 1;
      for (int k = 0; k < dimension_; ++k, rest /= cells, place *= cells / 2) {
        parent += rest % cells / 2 * place;
      }
      larger[parent] += counts[c];
      if (asked[c]) still[parent] = true;
    }
    counts = std::move(larger);
    asked = std::move(still);
    volume *= 1 << dimension_;
  }
}

}  // namespace spillway::geometry

#include "stream/tiles/cuts/sample_division.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "src/delaunay/division/axis_rule.h"
#include "src/delaunay/division/cut_judgement.h"
#include "src/delaunay/division/cut_rule.h"
#include "src/geometry/box.h"
#include "src/geometry/dimensions.h"
#include "stream/tiles/cuts/sample_mesh.h"

namespace spillway::stream {
namespace {

/// Points that are triangulated: for each part, and at most.
constexpr std::size_t kTriangulatedPerPart = 1'024;
constexpr std::size_t kMostTriangulated = 32'768;
/// Fewer triangulated points do not tell one cut from another.
constexpr std::size_t kFewestToTell = 200;
/// One of so many points of a cell: how far from the middle a cut may be where fewer simplices
/// cross it, and how far from there where the gap is wide. Cells of ranks stay of about equal size.
constexpr std::size_t kRoomForCrossing = 50;
constexpr std::size_t kRoomForGap = 128;

/// The least coordinate that is larger than `value`.
template <int D>
std::optional<double> next_value(std::span<const Point<D>> sample, int axis, double value) {
  std::optional<double> next;
  for (const Point<D>& p : sample) {
    if (p[axis] > value && (!next || p[axis] < *next)) next = p[axis];
  }
  return next;
}

/// The value of a cut across `axis` with about `below` points below it: in the middle of a wide gap
/// near there, so that what is apart stays apart. Where points near there are equal on the axis it
/// is their value, or the next one if nothing is lower. None if all points are equal on it.
template <int D>
std::optional<double> value_near(std::span<Point<D>> sample, int axis, std::size_t below) {
  const auto on_axis = [axis](const Point<D>& p) { return p[axis]; };
  const std::size_t room = sample.size() / kRoomForGap;
  below = std::clamp<std::size_t>(below, 1, sample.size() - 1);
  const std::size_t first = below - std::min(room, below - 1) - 1;
  const std::size_t last = std::min(below + room, sample.size() - 1);
  std::ranges::nth_element(sample, sample.begin() + static_cast<std::ptrdiff_t>(first), {},
                           on_axis);
  const std::span<Point<D>> not_below = sample.subspan(first);
  const std::span<Point<D>> near = not_below.first(last - first + 1);
  std::ranges::nth_element(not_below, near.end() - 1, {}, on_axis);
  std::ranges::sort(near, {}, on_axis);
  double widest = 0;
  std::optional<double> value;
  for (std::size_t i = 1; i < near.size(); ++i) {
    const double low = near[i - 1][axis];
    const double high = near[i][axis];
    const std::size_t place = first + i;
    const auto distance = static_cast<double>(place > below ? place - below : below - place);
    const double width = (high - low) * (1 - distance / static_cast<double>(room + 1));
    if (width <= widest) continue;
    widest = width;
    const double middle = std::midpoint(low, high);
    value = middle > low ? middle : high;
  }
  if (value) return value;
  const double equal = near.front()[axis];
  const bool lowest = std::ranges::min(sample, {}, on_axis)[axis] == equal;
  return lowest ? next_value<D>(sample, axis, equal) : std::optional(equal);
}

/// Cuts across the longest side of a cell, unless the triangulation of some of its points says that
/// another cut is crossed by fewer simplices; and in a wide gap near there.
template <int D>
class SampleMeshRule final : public CutRule<D> {
 public:
  explicit SampleMeshRule(SampleMesh<D> mesh) : mesh_(std::move(mesh)) {}

  [[nodiscard]] std::optional<Cut> choose(const PointsToCut<D>& points) const override {
    int axis = points.box.longest_axis();
    CutShare share = points.share;
    const std::size_t count = mesh_.points.size();
    if (count >= kFewestToTell && !mesh_.simplices.empty()) {
      const CutJudgement<D> judgement(mesh_.points, mesh_.weights, mesh_.simplices);
      const std::size_t room = count / kRoomForCrossing;
      axis = judgement.best_cut(axis, share.of(count), room).axis;
      // Again, as another place on the new axis must be better than its middle.
      const JudgedCut best = judgement.best_cut(axis, share.of(count), room);
      axis = best.axis;
      if (best.below != share.of(count)) share = {best.below, count};
    }
    const auto value = value_near<D>(points.sample, axis, share.of(points.sample.size()));
    return value ? std::optional(Cut{axis, *value}) : std::nullopt;
  }

  [[nodiscard]] std::array<std::unique_ptr<CutRule<D>>, 2> for_sides(
      const Cut& cut) const override {
    std::array<SampleMesh<D>, 2> sides = mesh_.sides(cut);
    return {std::make_unique<SampleMeshRule>(std::move(sides[0])),
            std::make_unique<SampleMeshRule>(std::move(sides[1]))};
  }

 private:
  SampleMesh<D> mesh_;
};

/// Divides a sample by a rule.
template <int D>
class SampleDivider {
 public:
  using Rule = std::shared_ptr<const CutRule<D>>;

  std::vector<DivisionCut> divide(std::span<const LatticePoint> sample, std::size_t parts,
                                  Rule rule) {
    std::vector<Point<D>> points;
    points.reserve(sample.size());
    for (const LatticePoint& p : sample) points.push_back(mesh_point<D>(p));
    divide_part(0, points, parts, std::move(rule));
    return std::move(cuts_);
  }

 private:
  void divide_part(std::uint32_t part, std::span<Point<D>> sample, std::size_t parts, Rule rule) {
    if (parts < 2 || sample.size() < 2) return;
    PointsToCut<D> points{.sample = sample, .share = {parts / 2, parts}};
    for (const Point<D>& p : sample) points.box.expand(p);
    std::optional<Cut> cut = rule->choose(points);
    if (!cut) return;
    std::size_t below = part_below(sample, *cut);
    if (below == 0) {
      const std::optional<double> next = next_value<D>(sample, cut->axis, cut->value);
      if (!next) return;  // all are equal
      cut->value = *next;
      below = part_below(sample, *cut);
    }
    cuts_.push_back({part, *cut});
    const auto other = static_cast<std::uint32_t>(cuts_.size());
    auto [low, high] = rule->for_sides(*cut);
    Rule for_low = low ? std::move(low) : rule;
    Rule for_high = high ? std::move(high) : rule;
    rule.reset();
    divide_part(part, sample.first(below), parts / 2, std::move(for_low));
    divide_part(other, sample.subspan(below), parts - parts / 2, std::move(for_high));
  }

  /// Puts the points below a cut to the front, and returns how many these are.
  static std::size_t part_below(std::span<Point<D>> sample, const Cut& cut) {
    const auto high = std::partition(sample.begin(), sample.end(),
                                     [&](const Point<D>& p) { return p[cut.axis] < cut.value; });
    return static_cast<std::size_t>(high - sample.begin());
  }

  std::vector<DivisionCut> cuts_;
};

template <int D>
std::vector<DivisionCut> divide_longest_axes(std::span<const LatticePoint> sample,
                                             std::size_t parts) {
  return SampleDivider<D>().divide(sample, std::min(parts, sample.size()),
                                   std::make_shared<AxisRule<D>>());
}

}  // namespace

template <int D>
std::vector<DivisionCut> divide_sample(std::span<const LatticePoint> sample, std::size_t parts) {
  parts = std::min(parts, sample.size());
  if (parts < 2) return {};
  const std::size_t triangulated = std::min(kTriangulatedPerPart * parts, kMostTriangulated);
  return SampleDivider<D>().divide(
      sample, parts,
      std::make_shared<SampleMeshRule<D>>(triangulate_sample<D>(sample, triangulated)));
}

std::vector<DivisionCut> divide_sample(std::span<const LatticePoint> sample, std::size_t parts,
                                       int dimension) {
  return with_cut_dimension(dimension, [&](auto d) { return divide_sample<d>(sample, parts); });
}

std::vector<DivisionCut> divide_sample_evenly(std::span<const LatticePoint> sample,
                                              std::size_t parts, int dimension) {
  return with_cut_dimension(dimension,
                            [&](auto d) { return divide_longest_axes<d>(sample, parts); });
}

#define SPILLWAY_INSTANTIATE(D) \
  template std::vector<DivisionCut> divide_sample<D>(std::span<const LatticePoint>, std::size_t);
SPILLWAY_FOR_EACH_CUT_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream

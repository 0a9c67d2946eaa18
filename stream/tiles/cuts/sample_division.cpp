#include "stream/tiles/cuts/sample_division.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "src/delaunay/division/cut_judgement.h"
#include "src/geometry/box.h"
#include "stream/tiles/cuts/sample_mesh.h"

namespace spillway::detail {
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
std::optional<double> next_value(std::span<const LatticePoint> sample, int axis, double value) {
  std::optional<double> next;
  for (const LatticePoint& p : sample) {
    if (p[axis] > value && (!next || p[axis] < *next)) next = p[axis];
  }
  return next;
}

/// The value of a cut across `axis` with about `below` points below it: in the middle of a wide gap
/// near there, so that what is apart stays apart. Where points near there are equal on the axis it
/// is their value, or the next one if nothing is lower. None if all points are equal on it.
std::optional<double> value_near(std::span<LatticePoint> sample, int axis, std::size_t below) {
  const auto on_axis = [axis](const LatticePoint& p) { return p[axis]; };
  const std::size_t room = sample.size() / kRoomForGap;
  below = std::clamp<std::size_t>(below, 1, sample.size() - 1);
  const std::size_t first = below - std::min(room, below - 1) - 1;
  const std::size_t last = std::min(below + room, sample.size() - 1);
  std::ranges::nth_element(sample, sample.begin() + static_cast<std::ptrdiff_t>(first), {},
                           on_axis);
  const std::span<LatticePoint> not_below = sample.subspan(first);
  const std::span<LatticePoint> near = not_below.first(last - first + 1);
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
  return lowest ? next_value(sample, axis, equal) : std::optional(equal);
}

template <int D>
class SampleDivider {
 public:
  std::vector<DivisionCut> divide(std::span<LatticePoint> sample, std::size_t parts) {
    if (parts > 1) {
      const std::size_t triangulated = std::min(kTriangulatedPerPart * parts, kMostTriangulated);
      divide_tile(0, sample, triangulate_sample<D>(sample, triangulated), parts);
    }
    return std::move(cuts_);
  }

 private:
  void divide_tile(std::uint32_t tile, std::span<LatticePoint> sample, SampleMesh<D> mesh,
                   std::size_t parts) {
    if (parts < 2 || sample.size() < 2) return;
    const std::size_t low_parts = parts / 2;
    const std::optional<TileCut> cut = place(sample, mesh, {low_parts, parts});
    if (!cut) return;
    cuts_.push_back({tile, *cut});
    const auto other = static_cast<std::uint32_t>(cuts_.size());
    const auto high = std::partition(sample.begin(), sample.end(), [&](const LatticePoint& p) {
      return p[cut->axis] < cut->value;
    });
    const auto below = static_cast<std::size_t>(high - sample.begin());
    std::array<SampleMesh<D>, 2> sides = mesh.sides(*cut);
    mesh = {};
    divide_tile(tile, sample.first(below), std::move(sides[0]), low_parts);
    divide_tile(other, sample.subspan(below), std::move(sides[1]), parts - low_parts);
  }

  /// How much of a cell is to lie below a cut: so many parts of so many.
  struct Share {
    std::size_t below;
    std::size_t all;

    [[nodiscard]] std::size_t of(std::size_t points) const { return points * below / all; }
  };

  static std::optional<TileCut> place(std::span<LatticePoint> sample, const SampleMesh<D>& mesh,
                                      Share share) {
    Box<D> box;
    for (const LatticePoint& p : sample) box.expand(mesh_point<D>(p));
    int axis = box.longest_axis();
    const std::size_t count = mesh.points.size();
    if (count >= kFewestToTell && !mesh.simplices.empty()) {
      const CutJudgement<D> judgement(mesh.points, mesh.weights, mesh.simplices);
      const std::size_t room = count / kRoomForCrossing;
      axis = judgement.best_cut(axis, share.of(count), room).axis;
      // Again, as another place on the new axis must be better than its middle.
      const JudgedCut best = judgement.best_cut(axis, share.of(count), room);
      axis = best.axis;
      if (best.below != share.of(count)) share = {best.below, count};
    }
    const std::optional<double> value = value_near(sample, axis, share.of(sample.size()));
    return value ? std::optional(TileCut{axis, *value}) : std::nullopt;
  }

  std::vector<DivisionCut> cuts_;
};

}  // namespace

template <int D>
std::vector<DivisionCut> divide_sample(std::vector<LatticePoint> sample, std::size_t parts) {
  return SampleDivider<D>().divide(sample, std::min(parts, sample.size()));
}

std::vector<DivisionCut> divide_sample(std::vector<LatticePoint> sample, std::size_t parts,
                                       int dimension) {
  return dimension == 2 ? divide_sample<2>(std::move(sample), parts)
                        : divide_sample<3>(std::move(sample), parts);
}

template std::vector<DivisionCut> divide_sample<2>(std::vector<LatticePoint>, std::size_t);
template std::vector<DivisionCut> divide_sample<3>(std::vector<LatticePoint>, std::size_t);

}  // namespace spillway::detail

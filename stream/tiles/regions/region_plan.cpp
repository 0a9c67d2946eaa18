#include "stream/tiles/regions/region_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "src/delaunay/division/cut_rule.h"
#include "stream/tiles/regions/reading_order.h"

namespace spillway::stream {
namespace {

/// The lower side of a cut gets this share of the points, at the least and at the most.
constexpr double kLeastShare = 0.4;
constexpr double kMostShare = 0.6;
/// A cell is not cut where one side would have less than this share of its points: then most of
/// them lie at one place, and only they can show how to cut it.
constexpr double kLeastSide = 0.1;
/// What uneven sides cost, against points of regions that lie on both sides.
constexpr double kUnevenCost = 0.5;
/// Most values that are looked at for a cut.
constexpr std::size_t kMostValues = 32;
/// Steps by which a value is found that has a share of the points below it.
constexpr int kBisections = 40;
/// There are about so many cells at the most, whatever headers claim: where more points are told,
/// cells expect more, and are cut when these come.
constexpr double kMostCells = 16'384;
/// Triangulating while reading pays from this share of points on that are complete early.
constexpr double kLeastEarly = 0.25;

/// The part of a region in a cell.
struct Portion {
  std::size_t region = 0;
  CountedBox<3> points{};
};

using Boxes = std::span<const CountedBox<3>>;

double points_below(Boxes boxes, const Cut& cut) {
  double points = 0;
  for (const CountedBox<3>& some : boxes) points += some.count * share_below(some.box, cut);
  return points;
}

double points_of(Boxes boxes) {
  double points = 0;
  for (const CountedBox<3>& some : boxes) points += some.count;
  return points;
}

std::vector<CountedBox<3>> boxes_of(const std::vector<Portion>& portions) {
  std::vector<CountedBox<3>> boxes;
  boxes.reserve(portions.size());
  for (const Portion& portion : portions) boxes.push_back(portion.points);
  return boxes;
}

Box<3> box_around(Boxes boxes) {
  Box<3> box;
  for (const CountedBox<3>& some : boxes) box.expand(some.box);
  return box;
}

/// The least value with so many points below it, about.
double quantile(Boxes boxes, int axis, const Box<3>& box, double points) {
  double lo = box.lo[axis];
  double hi = box.hi[axis];
  for (int step = 0; step < kBisections; ++step) {
    const double middle = lo + (hi - lo) / 2;
    (points_below(boxes, {axis, middle}) < points ? lo : hi) = middle;
  }
  return hi;
}

/// A value where a cell could be cut.
struct CutValue {
  double value = 0;
  double parted = 0;  ///< points of regions that have some on both sides

  bool operator<(const CutValue& other) const {
    return std::pair(parted, value) < std::pair(other.parted, other.value);
  }
};

/// The sides of regions between two values, and one value more.
std::vector<CutValue> cut_values(Boxes boxes, int axis, double least, double most, double middle) {
  std::vector<std::pair<double, double>> begins;  // points begin to be parted above the side ...
  std::vector<std::pair<double, double>> ends;    // ... and are not any more above this one
  std::vector<CutValue> values = {{middle}};
  for (const CountedBox<3>& some : boxes) {
    begins.emplace_back(some.box.lo[axis], some.count);
    ends.emplace_back(some.box.hi[axis], some.count);
    for (const double value : {some.box.lo[axis], some.box.hi[axis]}) {
      if (value > least && value < most) values.push_back({value});
    }
  }
  std::ranges::sort(begins);
  std::ranges::sort(ends);
  std::ranges::sort(values, {}, &CutValue::value);
  auto begin = begins.begin();
  auto end = ends.begin();
  double parted = 0;
  for (CutValue& value : values) {
    for (; begin != begins.end() && begin->first < value.value; ++begin) parted += begin->second;
    for (; end != ends.end() && end->first < value.value; ++end) parted -= end->second;
    value.parted = parted;
  }
  return values;
}

/// Cuts a cell across its longest side, at the sides of regions if that parts the points evenly
/// enough.
class RegionSidesRule final : public CutRule<3> {
 public:
  explicit RegionSidesRule(int dimension) : dimension_(dimension) {}

  [[nodiscard]] std::optional<Cut> choose(const PointsToCut<3>& points) const override {
    const Boxes boxes = points.boxes;
    const double all = points_of(boxes);
    int axis = 0;
    for (int k = 1; k < dimension_; ++k) {
      if (points.box.extent(k) > points.box.extent(axis)) axis = k;
    }
    if (!(points.box.extent(axis) > 0)) return std::nullopt;
    const auto at = [&](double share) { return quantile(boxes, axis, points.box, share * all); };
    std::vector<CutValue> values =
        cut_values(boxes, axis, at(kLeastShare), at(kMostShare), at(0.5));
    const std::size_t looked_at = std::min(values.size(), kMostValues);
    std::partial_sort(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(looked_at),
                      values.end());
    values.resize(looked_at);
    const auto cost = [&](const CutValue& value) {
      const double uneven = std::abs(points_below(boxes, {axis, value.value}) / all - 0.5);
      return value.parted / all + kUnevenCost * uneven;
    };
    return Cut{axis, std::ranges::min_element(values, {}, cost)->value};
  }

 private:
  int dimension_;
};

/// Where a rule cuts what a cell has of regions.
std::optional<Cut> choose_cut(const std::vector<Portion>& portions, const CutRule<3>& rule) {
  const std::vector<CountedBox<3>> boxes = boxes_of(portions);
  return rule.choose({.boxes = boxes, .box = box_around(boxes)});
}

/// Appends regions in the order of cells with one region each.
void append_nested(std::vector<Portion> portions, const CutRule<3>& rule,
                   std::vector<std::size_t>& order) {
  const auto cut = portions.size() > 1 ? choose_cut(portions, rule) : std::nullopt;
  std::array<std::vector<Portion>, 2> sides;
  for (const Portion& portion : portions) {
    const bool above = cut && share_below(portion.points.box, *cut) <= 0.5;
    sides[above ? 1 : 0].push_back(portion);
  }
  const bool parts = !sides[0].empty() && !sides[1].empty();
  portions = {};
  for (std::vector<Portion>& side : sides) {
    if (parts) {
      append_nested(std::move(side), rule, order);
    } else {
      for (const Portion& portion : side) order.push_back(portion.region);
    }
  }
}

/// Regions with points, each as one portion.
std::vector<Portion> portions_of(std::span<const InputRegion> regions) {
  std::vector<Portion> portions;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const InputRegion& region = regions[r];
    if (region.box.empty()) continue;
    portions.push_back({r, {region.box, static_cast<double>(region.count)}});
  }
  return portions;
}

/// Cuts the plane or space into cells, and keeps what each has of the regions.
class Planner {
 public:
  Planner(int dimension, double most_points)
      : most_points_(most_points), rule_(dimension), cuts_(dimension) {}

  void cut(std::uint32_t tile, std::vector<Portion> portions) {
    const std::optional<Cut> best = cut_of(portions);
    if (best) return cut_at(tile, std::move(portions), *best);
    if (by_cell.size() <= tile) by_cell.resize(tile + 1);
    in_order.push_back(tile);
    by_cell[tile] = std::move(portions);
  }

  [[nodiscard]] CutTree take_cuts() {
    cuts_.renew_lookup();
    return std::move(cuts_);
  }

  std::vector<std::vector<Portion>> by_cell;
  std::vector<std::uint32_t> in_order;  ///< cells, neighbours soon after each other

 private:
  /// None for a cell that is small enough, or that has nearly all points on one side.
  [[nodiscard]] std::optional<Cut> cut_of(const std::vector<Portion>& portions) const {
    const std::vector<CountedBox<3>> boxes = boxes_of(portions);
    const double points = points_of(boxes);
    if (points <= most_points_) return std::nullopt;
    const std::optional<Cut> best = rule_.choose({.boxes = boxes, .box = box_around(boxes)});
    if (!best) return std::nullopt;
    const double below = points_below(boxes, *best);
    return std::min(below, points - below) >= kLeastSide * points ? best : std::nullopt;
  }

  void cut_at(std::uint32_t tile, std::vector<Portion> portions, const Cut& where) {
    const std::uint32_t other = cuts_.tiles();
    cuts_.make_cut(tile, where.axis, where.value);
    std::array<std::vector<Portion>, 2> sides;
    for (const Portion& portion : portions) {
      const double below = share_below(portion.points.box, where);
      for (const int side : {0, 1}) {
        Portion part = portion;
        part.points.box = part_of(portion.points.box, where, side);
        part.points.count *= side == 0 ? below : 1 - below;
        if (!part.points.box.empty()) sides[side].push_back(part);
      }
    }
    portions = {};
    cut(tile, std::move(sides[0]));
    cut(other, std::move(sides[1]));
  }

  double most_points_;
  RegionSidesRule rule_;
  CutTree cuts_;
};

/// Units in their own order, or so that few points wait.
std::vector<std::size_t> order_units(std::span<const InputRegion> regions, const Planner& planner,
                                     bool any_order) {
  std::vector<double> points;  // by unit
  for (const InputRegion& region : regions) {
    points.resize(std::max(points.size(), region.unit + 1));
    points[region.unit] += static_cast<double>(region.count);
  }
  if (!any_order) {
    std::vector<std::size_t> units(points.size());
    std::iota(units.begin(), units.end(), std::size_t{0});
    return units;
  }
  std::vector<WaitingCell> cells;
  for (const std::uint32_t c : planner.in_order) {
    WaitingCell& cell = cells.emplace_back();
    for (const Portion& portion : planner.by_cell[c]) {
      cell.points += portion.points.count;
      const std::size_t unit = regions[portion.region].unit;
      if (cell.units.empty() || cell.units.back() != unit) cell.units.push_back(unit);
    }
  }
  return reading_order(cells, points);
}

/// The order in which regions come, if their units are read as planned.
void order_regions(std::span<const InputRegion> regions, RegionPlan& plan) {
  std::vector<std::vector<std::size_t>> of_unit(plan.order.units.size());
  for (std::size_t r = 0; r < regions.size(); ++r) of_unit[regions[r].unit].push_back(r);
  for (const std::size_t unit : plan.order.units) {
    plan.order.regions.insert(plan.order.regions.end(), of_unit[unit].begin(), of_unit[unit].end());
  }
}

void tell_when_done(const Planner& planner, RegionPlan& plan) {
  std::vector<std::size_t> position(plan.order.regions.size());
  for (std::size_t p = 0; p < position.size(); ++p) position[plan.order.regions[p]] = p;
  plan.cells.resize(planner.by_cell.size());
  plan.done_after.resize(plan.order.regions.size());
  for (const std::uint32_t c : planner.in_order) {
    RegionPlan::Cell& cell = plan.cells[c];
    const std::vector<Portion>& portions = planner.by_cell[c];
    const std::vector<CountedBox<3>> boxes = boxes_of(portions);
    cell.box = box_around(boxes);
    cell.expected = points_of(boxes);
    for (const Portion& portion : portions) {
      cell.done_after = std::max(cell.done_after, position[portion.region]);
    }
    plan.done_after[cell.done_after].push_back(c);
  }
}

/// How many points wait while the regions come.
void expect_waiting(std::span<const InputRegion> regions, RegionPlan& plan) {
  double all = 0;
  double done = 0;
  double read = 0;
  std::size_t last = 0;
  for (std::size_t p = 0; p < plan.order.regions.size(); ++p) {
    const InputRegion& region = regions[plan.order.regions[p]];
    if (region.box.empty()) continue;
    all += static_cast<double>(region.count);
    last = p;
  }
  for (std::size_t p = 0; p < plan.order.regions.size(); ++p) {
    const InputRegion& region = regions[plan.order.regions[p]];
    if (!region.box.empty()) read += static_cast<double>(region.count);
    plan.most_waiting = std::max(plan.most_waiting, read - done);
    if (p == last) break;
    for (const std::uint32_t cell : plan.done_after[p]) done += plan.cells[cell].expected;
  }
  plan.done_early = all > 0 ? done / all : 0;
}

}  // namespace

RegionPlan plan_regions(std::span<const InputRegion> regions, const RegionPlanOptions& options) {
  std::vector<Portion> portions = portions_of(regions);
  Planner planner(options.dimension,
                  std::max(options.most_points, points_of(boxes_of(portions)) / kMostCells));
  planner.cut(0, std::move(portions));
  RegionPlan plan{.cuts = planner.take_cuts()};
  plan.order.units = order_units(regions, planner, options.any_order);
  order_regions(regions, plan);
  tell_when_done(planner, plan);
  expect_waiting(regions, plan);
  return plan;
}

std::vector<std::size_t> nested_order(std::span<const InputRegion> regions, int dimension) {
  std::vector<std::size_t> order;
  append_nested(portions_of(regions), RegionSidesRule(dimension), order);
  return order;
}

bool pays(const RegionPlan& plan) { return plan.done_early >= kLeastEarly; }

}  // namespace spillway::stream

#include "stream/tiles/regions/region_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace spillway::test {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::Gt;
using ::testing::IsEmpty;
using ::testing::Le;
using ::testing::Lt;

Box<3> box_between(const LatticePoint& lo, const LatticePoint& hi) {
  Box<3> box;
  box.expand(lo);
  box.expand(hi);
  return box;
}

/// Unit squares in rows, a file each.
std::vector<InputRegion> squares(int side, std::uint64_t points, double margin = 0) {
  std::vector<InputRegion> regions;
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      const Box<3> box =
          box_between({x - margin, y - margin, 0}, {x + 1 + margin, y + 1 + margin, 9});
      regions.push_back({regions.size(), box, points});
    }
  }
  return regions;
}

/// Each point of a region lies in a cell that is complete after that region or later, and in the
/// cell's box.
void expect_to_hold(const RegionPlan& plan, const std::vector<InputRegion>& regions,
                    int dimension) {
  ASSERT_EQ(plan.cells.size(), plan.cuts.tiles());
  std::vector<std::size_t> position(regions.size());
  for (std::size_t p = 0; p < plan.order.regions.size(); ++p)
    position.at(plan.order.regions[p]) = p;
  std::mt19937 random(1);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Box<3>& box = regions[r].box;
    if (box.empty()) continue;
    std::vector<LatticePoint> points = {LatticePoint(box.lo), LatticePoint(box.hi)};
    for (int i = 0; i < 50; ++i) {
      LatticePoint& point = points.emplace_back();
      for (int k = 0; k < 3; ++k) {
        point[k] = std::uniform_real_distribution<double>(box.lo[k], box.hi[k])(random);
      }
    }
    std::vector<std::uint32_t> cells(points.size());
    plan.cuts.find_tiles(points, cells);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const RegionPlan::Cell& cell = plan.cells[cells[i]];
      EXPECT_GE(cell.done_after, position[r]);
      for (int k = 0; k < dimension; ++k) {
        EXPECT_GE(points[i][k], cell.box.lo[k]);
        EXPECT_LE(points[i][k], cell.box.hi[k]);
      }
    }
  }
  std::vector<int> told(plan.cells.size());
  for (std::size_t p = 0; p < plan.done_after.size(); ++p) {
    for (const std::uint32_t cell : plan.done_after[p]) {
      ++told[cell];
      EXPECT_EQ(plan.cells[cell].done_after, p);
    }
  }
  EXPECT_THAT(told, Each(1));
}

TEST(RegionPlan, CellsExpectAtMostSoManyPointsAndAllOfThem) {
  const auto regions = squares(10, 1000, 0.1);
  const RegionPlan plan = plan_regions(regions, {.most_points = 2500});
  expect_to_hold(plan, regions, 2);
  double all = 0;
  for (const RegionPlan::Cell& cell : plan.cells) {
    EXPECT_THAT(cell.expected, Le(2500));
    EXPECT_THAT(cell.expected, Ge(2500 / 3.0));
    all += cell.expected;
  }
  EXPECT_NEAR(all, 100'000, 1e-3);
}

TEST(RegionPlan, CutsWhereFilesMeet) {
  const RegionPlan plan = plan_regions(squares(2, 1000), {.most_points = 1000});
  ASSERT_EQ(plan.cells.size(), 4U);
  for (const RegionPlan::Cell& cell : plan.cells) EXPECT_NEAR(cell.expected, 1000, 1e-6);
}

TEST(RegionPlan, UnitsComeSoThatFewPointsWait) {
  auto regions = squares(16, 1000, 0.05);
  std::shuffle(regions.begin(), regions.end(), std::mt19937(2));
  for (std::size_t r = 0; r < regions.size(); ++r) regions[r].unit = r;
  const RegionPlan plan = plan_regions(regions, {.most_points = 2000});
  expect_to_hold(plan, regions, 2);
  EXPECT_TRUE(pays(plan));
  EXPECT_THAT(plan.most_waiting, Lt(60'000)) << "of 256,000";
  const RegionPlan as_named = plan_regions(regions, {.most_points = 2000, .any_order = false});
  expect_to_hold(as_named, regions, 2);
  EXPECT_THAT(as_named.most_waiting, Gt(120'000));
  EXPECT_THAT(as_named.order.units.front(), 0U);
  EXPECT_TRUE(std::ranges::is_sorted(as_named.order.units));
}

TEST(RegionPlan, KeepsTheRegionsOfOneUnitInTheirOrder) {
  auto regions = squares(8, 1000);
  for (InputRegion& region : regions) region.unit = 0;
  const RegionPlan plan = plan_regions(regions, {.most_points = 1500});
  expect_to_hold(plan, regions, 2);
  EXPECT_THAT(plan.order.units, ElementsAre(0U));
  EXPECT_TRUE(std::ranges::is_sorted(plan.order.regions));
  EXPECT_TRUE(pays(plan));
}

TEST(RegionPlan, DoesNotPayWhereEverythingWaitsForTheLast) {
  auto regions = squares(4, 1000);
  regions.push_back({16, box_between({0, 0, 0}, {4, 4, 9}), 1000});
  EXPECT_TRUE(pays(plan_regions(regions, {.most_points = 1500}))) << "that is read first";
  EXPECT_FALSE(pays(plan_regions(regions, {.most_points = 1500, .any_order = false})));
  EXPECT_FALSE(pays(plan_regions(squares(1, 100'000), {.most_points = 1000}))) << "one file";
}

TEST(RegionPlan, OfRegionsWithoutPointsHasOneCell) {
  const std::vector<InputRegion> regions = {{0, {}, 0}, {1, {}, 0}};
  const RegionPlan plan = plan_regions(regions, {.most_points = 10});
  EXPECT_EQ(plan.cells.size(), 1U);
  EXPECT_TRUE(plan.cells[0].box.empty());
  EXPECT_THAT(plan.order.units, ElementsAre(0U, 1U));
  EXPECT_FALSE(pays(plan));
}

TEST(RegionPlan, CountsThatLieMakeFewCells) {
  constexpr std::size_t kMany = 200'000;
  for (const std::uint64_t lie : {std::uint64_t{70'300'024'700'928}, std::uint64_t{1} << 62}) {
    auto regions = squares(3, 1000);
    regions[4].count = lie;
    for (const int dimension : {2, 3}) {
      const RegionPlan plan = plan_regions(regions, {.dimension = dimension, .most_points = 100});
      EXPECT_LT(plan.cells.size(), kMany) << lie;
      expect_to_hold(plan, regions, dimension);
    }
  }
}

TEST(RegionPlan, TakesFlatBoxesAndEqualOnes) {
  std::vector<InputRegion> regions = squares(3, 1000);
  for (std::size_t i = 0; i < 9; ++i) {
    regions.push_back({9 + i, box_between({1, 1, 1}, {1, 1, 1}), 5000});
    regions.push_back({18 + i, box_between({0, 2, 0}, {3, 2, 0}), 5000});
  }
  for (std::size_t r = 0; r < regions.size(); ++r) regions[r].unit = r;
  const RegionPlan plan = plan_regions(regions, {.most_points = 2000});
  expect_to_hold(plan, regions, 2);
}

TEST(RegionPlan, OfSpaceCutsAllAxes) {
  std::vector<InputRegion> regions;
  for (int i = 0; i < 64; ++i) {
    const double x = i % 4;
    const double y = i / 4 % 4;
    const double z = i / 16;
    regions.push_back({regions.size(), box_between({x, y, z}, {x + 1, y + 1, z + 1}), 1000});
  }
  const RegionPlan plan = plan_regions(regions, {.dimension = 3, .most_points = 1500});
  expect_to_hold(plan, regions, 3);
  EXPECT_THAT(plan.cells.size(), Ge(50U));
  for (const RegionPlan::Cell& cell : plan.cells) {
    for (int k = 0; k < 3; ++k) EXPECT_THAT(cell.box.extent(k), Le(2));
  }
}

/// Cells that begin with a region and are complete with one that is farther from it than all of
/// their regions together.
std::size_t torn_cells(std::span<const InputRegion> in_order, double most_points) {
  const RegionPlan plan = plan_regions(in_order, {.most_points = most_points, .any_order = false});
  const auto meet = [](const Box<3>& a, const Box<3>& b) {
    return a.lo[0] < b.hi[0] && b.lo[0] < a.hi[0] && a.lo[1] < b.hi[1] && b.lo[1] < a.hi[1];
  };
  std::size_t torn = 0;
  for (const RegionPlan::Cell& cell : plan.cells) {
    std::vector<std::size_t> of_cell;
    for (std::size_t r = 0; r < in_order.size(); ++r) {
      if (meet(in_order[r].box, cell.box)) of_cell.push_back(r);
    }
    torn += of_cell.back() - of_cell.front() >= of_cell.size() ? 1 : 0;
  }
  return torn;
}

TEST(RegionPlan, OfRegionsInNestedOrderHasTheCellsOneAfterTheOther) {
  std::vector<InputRegion> regions = squares(16, 1000, -0.01);
  std::mt19937 random(3);
  std::ranges::shuffle(regions, random);
  EXPECT_THAT(torn_cells(regions, 4000), Gt(32U));
  std::vector<InputRegion> in_order;
  for (const std::size_t r : nested_order(regions, 2)) in_order.push_back(regions[r]);
  EXPECT_EQ(in_order.size(), regions.size());
  for (const double most_points : {1000, 2000, 4000, 32'000, 100'000}) {
    EXPECT_EQ(torn_cells(in_order, most_points), 0U) << most_points;
  }
}

TEST(RegionPlan, NestedOrderHasEachRegionWithPointsOnce) {
  std::vector<InputRegion> regions = squares(5, 1000, 0.3);
  for (std::size_t i = 0; i < 9; ++i) {
    regions.push_back({0, box_between({1, 1, 1}, {1, 1, 1}), 5000});
    regions.push_back({0, Box<3>{}, 0});
  }
  std::vector<std::size_t> order = nested_order(regions, 2);
  EXPECT_EQ(order.size(), 34U);
  std::ranges::sort(order);
  EXPECT_EQ(std::ranges::adjacent_find(order), order.end());
  for (const std::size_t r : order) EXPECT_FALSE(regions[r].box.empty());
  EXPECT_THAT(nested_order({}, 2), IsEmpty());
}

}  // namespace
}  // namespace spillway::test

// A lookup finds the cell of a point, as a search of all cells does, in few steps.

#include "stream/tiles/cuts/cut_lookup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "src/geometry/framed_point.h"

namespace spillway::test {
namespace {

std::int32_t find(const CutLookup& lookup, const LatticePoint& point) {
  std::int32_t ref = lookup.root();
  while (ref >= 0) {
    const CutNode& cut = lookup.cuts()[ref];
    ref = cut.sides[point[cut.axis] >= cut.value ? 1 : 0];
  }
  return ref;
}

std::int32_t find_naively(const std::vector<TileCell>& cells, const LatticePoint& point) {
  const auto found = std::ranges::find_if(cells, [&](const TileCell& cell) {
    for (int k = 0; k < 3; ++k) {
      if (point[k] < cell.box.lo[k] || point[k] >= cell.box.hi[k]) return false;
    }
    return true;
  });
  return found == cells.end() ? 0 : found->tile;
}

std::vector<TileCell> one_cell() { return {{whole_space<3>(), -1}}; }

/// The cell keeps what is below.
void cut(std::vector<TileCell>& cells, std::size_t number, int axis, double value) {
  TileCell other = cells[number];
  other.box.lo[axis] = value;
  other.tile = -1 - static_cast<std::int32_t>(cells.size());
  cells[number].box.hi[axis] = value;
  cells.push_back(other);
}

/// Cells of random cuts; coordinates are small integers, so that many points lie on cuts.
std::vector<TileCell> random_cells(int dimension, std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<TileCell> cells = one_cell();
  while (cells.size() < count) {
    const std::size_t number = random() % cells.size();
    const int axis = static_cast<int>(random() % static_cast<unsigned>(dimension));
    const double value = random() % 64;
    const Box<3>& box = cells[number].box;
    if (value > box.lo[axis] && value < box.hi[axis]) cut(cells, number, axis, value);
  }
  return cells;
}

void expect_naive_result(const std::vector<TileCell>& cells, int dimension) {
  const CutLookup lookup(cells, dimension);
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    LatticePoint point;
    for (double& x : point) x = 0.5 * (random() % 140) - 3;
    ASSERT_EQ(find(lookup, point), find_naively(cells, point)) << point[0] << ' ' << point[1];
  }
}

TEST(CutLookup, OfOneCellNeedsNoStep) {
  const CutLookup lookup(one_cell(), 2);
  EXPECT_EQ(lookup.root(), -1);
  EXPECT_EQ(lookup.depth(), 0);
  EXPECT_TRUE(lookup.cuts().empty());
}

TEST(CutLookup, FindsWhatASearchOfAllCellsFinds) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    for (const int dimension : {2, 3}) {
      expect_naive_result(random_cells(dimension, 5 + 15 * seed, seed), dimension);
    }
  }
}

TEST(CutLookup, OfAChainOfCutsHasTheDepthOfABalancedTree) {
  for (const bool upwards : {false, true}) {
    std::vector<TileCell> cells = one_cell();
    for (int i = 1; i < 1024; ++i) {
      upwards ? cut(cells, cells.size() - 1, 0, i) : cut(cells, 0, 0, 1024 - i);
    }
    EXPECT_EQ(CutLookup(cells, 2).depth(), 10);
    expect_naive_result(cells, 2);
  }
}

TEST(CutLookup, OfAChainThatTurnsStaysFlat) {
  for (const int dimension : {2, 3}) {
    std::vector<TileCell> cells = one_cell();
    for (int i = 1; i < 600; ++i) cut(cells, cells.size() - 1, i % dimension, i);
    EXPECT_LE(CutLookup(cells, dimension).depth(), 20);
    expect_naive_result(cells, dimension);
  }
}

TEST(CutLookup, OfRandomCutsIsNotMuchDeeperThanTheLogarithm) {
  for (const int dimension : {2, 3}) {
    EXPECT_LE(CutLookup(random_cells(dimension, 400, 9), dimension).depth(), 20);
  }
}

}  // namespace
}  // namespace spillway::test

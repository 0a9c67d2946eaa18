#include "stream/tiles/cuts/cut_lookup.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace spillway::stream {
namespace {

struct Choice {
  int axis = 0;
  double value = 0;
  std::size_t larger_side = 0;
};

/// The cut at the median of where cells begin; nothing if none begins inside of the region.
std::optional<Choice> middle_cut(const std::vector<TileCell>& cells, const Box<3>& region,
                                 int axis) {
  std::vector<double> begins;
  for (const TileCell& cell : cells) {
    if (cell.box.lo[axis] > region.lo[axis]) begins.push_back(cell.box.lo[axis]);
  }
  if (begins.empty()) return std::nullopt;
  const auto middle = begins.begin() + static_cast<std::ptrdiff_t>(begins.size() / 2);
  std::nth_element(begins.begin(), middle, begins.end());
  const double value = *middle;
  const auto below =
      std::ranges::count_if(cells, [&](const TileCell& cell) { return cell.box.lo[axis] < value; });
  const auto above =
      std::ranges::count_if(cells, [&](const TileCell& cell) { return cell.box.hi[axis] > value; });
  return Choice{axis, value, static_cast<std::size_t>(std::max(below, above))};
}

}  // namespace

CutLookup::CutLookup(std::vector<TileCell> cells, int dimension) : dimension_(dimension) {
  root_ = add(std::move(cells), whole_space<3>(), 0);
}

std::int32_t CutLookup::add(std::vector<TileCell> cells, const Box<3>& region, int depth) {
  depth_ = std::max(depth_, depth);
  std::optional<Choice> best;
  for (int k = 0; cells.size() > 1 && k < dimension_; ++k) {
    const std::optional<Choice> choice = middle_cut(cells, region, k);
    if (choice && (!best || choice->larger_side < best->larger_side)) best = choice;
  }
  if (!best) return cells.front().tile;
  std::vector<TileCell> below;
  for (const TileCell& cell : cells) {
    if (cell.box.lo[best->axis] < best->value) below.push_back(cell);
  }
  std::erase_if(cells,
                [&](const TileCell& cell) { return cell.box.hi[best->axis] <= best->value; });
  const std::size_t number = cuts_.size();
  cuts_.push_back({best->value, best->axis});
  Box<3> side = region;
  side.hi[best->axis] = best->value;
  cuts_[number].sides[0] = add(std::move(below), side, depth + 1);
  side = region;
  side.lo[best->axis] = best->value;
  cuts_[number].sides[1] = add(std::move(cells), side, depth + 1);
  return static_cast<std::int32_t>(number);
}

}  // namespace spillway::stream

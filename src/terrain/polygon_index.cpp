#include "src/terrain/polygon_index.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spillway::terrain {

namespace {

/// In how many cells a polygon may be, on average: large ones make for fewer cells.
constexpr std::size_t kMostCellsOfPolygon = 16;

}  // namespace

PolygonIndex::PolygonIndex(std::vector<PolygonEdges> polygons) : polygons_(std::move(polygons)) {
  for (const PolygonEdges& polygon : polygons_) box_.expand(polygon.box());
  const double count = std::max<double>(static_cast<double>(polygons_.size()), 1);
  cells_ = static_cast<std::size_t>(std::ceil(std::sqrt(count)));
  const auto entries = [&] {
    std::size_t sum = 0;
    for (const PolygonEdges& polygon : polygons_) {
      const Box<2>& box = polygon.box();
      if (box.empty()) continue;
      sum += (cell_of(box.hi[0], 0) - cell_of(box.lo[0], 0) + 1) *
             (cell_of(box.hi[1], 1) - cell_of(box.lo[1], 1) + 1);
    }
    return sum;
  };
  while (cells_ > 1 && entries() > kMostCellsOfPolygon * polygons_.size()) cells_ /= 2;
  grid_.resize(cells_ * cells_);
  for (std::uint32_t p = 0; p < polygons_.size(); ++p) {
    const Box<2>& box = polygons_[p].box();
    if (box.empty()) continue;
    for (std::size_t row = cell_of(box.lo[1], 1); row <= cell_of(box.hi[1], 1); ++row) {
      for (std::size_t column = cell_of(box.lo[0], 0); column <= cell_of(box.hi[0], 0); ++column) {
        grid_[row * cells_ + column].push_back(p);
      }
    }
  }
}

/// Of what lies beyond the box, the outermost one.
std::size_t PolygonIndex::cell_of(double coordinate, int axis) const {
  const double length = box_.extent(axis);
  if (!(length > 0)) return 0;
  const double cell = (coordinate - box_.lo[axis]) / length * static_cast<double>(cells_);
  return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(cells_ - 1)));
}

bool PolygonIndex::contains(const Point<2>& place) const {
  return box_.contains(place) &&
         std::ranges::any_of(cell(cell_of(place[1], 1), cell_of(place[0], 0)),
                             [&](std::uint32_t p) { return polygons_[p].contains(place); });
}

void PolygonIndex::find(const Point<2>& place, std::vector<std::size_t>& found) const {
  found.clear();
  if (!box_.contains(place)) return;
  for (const std::uint32_t p : cell(cell_of(place[1], 1), cell_of(place[0], 0))) {
    if (polygons_[p].contains(place)) found.push_back(p);
  }
}

std::vector<std::uint32_t> PolygonIndex::near(const Box<2>& box) const {
  std::vector<std::uint32_t> near;
  if (box.empty()) return near;
  for (std::size_t row = cell_of(box.lo[1], 1); row <= cell_of(box.hi[1], 1); ++row) {
    for (std::size_t column = cell_of(box.lo[0], 0); column <= cell_of(box.hi[0], 0); ++column) {
      near.insert(near.end(), cell(row, column).begin(), cell(row, column).end());
    }
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

}  // namespace spillway::terrain

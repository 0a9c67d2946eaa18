#include "stream/library/tiling/vector_polygons.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/gdal/gdal.h"

namespace spillway::stream {

VectorPolygons::VectorPolygons(const std::string& pattern, const std::string& polygons) {
  NamedPolygons named = read_named_polygons(pattern, polygons);
  crs_ = std::move(named.crs);
  paths_ = std::move(named.paths);
  rings_ = std::move(named.rings);
  for (const PolygonRings& rings : rings_) {
    box_.expand(polygons_.emplace_back(rings).box());
  }
  cells_ = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(polygons_.size()))));
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
std::size_t VectorPolygons::cell_of(double coordinate, int axis) const {
  const double length = box_.extent(axis);
  if (!(length > 0)) return 0;
  const double cell = (coordinate - box_.lo[axis]) / length * static_cast<double>(cells_);
  return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(cells_ - 1)));
}

/// Those whose boxes may meet a box, ascending.
void VectorPolygons::find_near(const Box<2>& box) {
  near_.clear();
  if (box.empty()) return;
  for (std::size_t row = cell_of(box.lo[1], 1); row <= cell_of(box.hi[1], 1); ++row) {
    for (std::size_t column = cell_of(box.lo[0], 0); column <= cell_of(box.hi[0], 0); ++column) {
      const std::vector<std::uint32_t>& cell = grid_[row * cells_ + column];
      near_.insert(near_.end(), cell.begin(), cell.end());
    }
  }
  std::sort(near_.begin(), near_.end());
  near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
}

void VectorPolygons::cut(std::span<const Point<2>> line, const TakePiece& take) {
  Box<2> box;
  for (const Point<2>& point : line) box.expand(point);
  find_near(box);
  for (const std::uint32_t p : near_) {
    polygons_[p].cut(line, [&](std::span<const Point<2>> piece) { take(p, piece); });
  }
}

void VectorPolygons::cut_polygon(const PolygonRings& polygon, const TakePart& take) {
  Box<2> box;
  for (const Point<2>& point : polygon.front()) box.expand(point);
  find_near(box);
  for (const std::uint32_t p : near_) {
    for (const PolygonRings& part : gdal().clip(polygon, rings_[p])) take(p, part);
  }
}

void VectorPolygons::find(const Point<2>& place, std::vector<std::size_t>& tiles) {
  tiles.clear();
  if (!box_.contains(place)) return;
  for (const std::uint32_t p : grid_[cell_of(place[1], 1) * cells_ + cell_of(place[0], 0)]) {
    if (polygons_[p].contains(place)) tiles.push_back(p);
  }
}

}  // namespace spillway::stream

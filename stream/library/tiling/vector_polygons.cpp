#include "stream/library/tiling/vector_polygons.h"

#include <utility>

#include "formats/gdal/gdal.h"

namespace spillway::stream {
namespace {

PolygonIndex index_of(const std::vector<PolygonRings>& polygons) {
  return PolygonIndex(std::vector<PolygonEdges>(polygons.begin(), polygons.end()));
}

}  // namespace

VectorPolygons::VectorPolygons(const std::string& pattern, const std::string& polygons)
    : named_(read_named_polygons(pattern, polygons)), index_(index_of(named_.rings)) {}

void VectorPolygons::cut(std::span<const Point<2>> line, const TakePiece& take) {
  for (const std::uint32_t p : index_.near(box_of_line(line))) {
    index_.polygon(p).cut(line, [&](std::span<const Point<2>> piece) { take(p, piece); });
  }
}

void VectorPolygons::cut_polygon(const PolygonRings& polygon, const TakePart& take) {
  for (const std::uint32_t p : index_.near(box_of_line(polygon.front()))) {
    for (const PolygonRings& part : gdal().clip(polygon, named_.rings[p])) take(p, part);
  }
}

}  // namespace spillway::stream

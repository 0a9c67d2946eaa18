#include "formats/gdal/module/ogr_clip.h"

#include <fmt/format.h>
#include <ogr_geometry.h>

#include <algorithm>
#include <cstddef>
#include <memory>

#include "formats/gdal/module/gdal_errors.h"
#include "formats/gdal/module/ogr_polygons.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

std::unique_ptr<OGRLinearRing> ring_of(const std::vector<Point<2>>& points) {
  auto ring = std::make_unique<OGRLinearRing>();
  ring->setNumPoints(static_cast<int>(points.size()), FALSE);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ring->setPoint(static_cast<int>(i), points[i][0], points[i][1]);
  }
  ring->closeRings();
  return ring;
}

/// Of an outer ring and holes.
OGRPolygon polygon_of(const PolygonRings& rings) {
  OGRPolygon polygon;
  for (const auto& ring : rings) polygon.addRingDirectly(ring_of(ring).release());
  return polygon;
}

/// Of rings in no order, by the even-odd rule where they cross or overlap.
std::unique_ptr<OGRGeometry> area_of(const PolygonRings& rings) {
  std::vector<OGRGeometry*> polygons;
  for (const auto& ring : rings) {
    if (ring.size() < 3) continue;
    auto polygon = std::make_unique<OGRPolygon>();
    polygon->addRingDirectly(ring_of(ring).release());
    polygons.push_back(polygon.release());
  }
  if (polygons.empty()) return nullptr;
  int is_valid = FALSE;
  std::unique_ptr<OGRGeometry> area(OGRGeometryFactory::organizePolygons(
      polygons.data(), static_cast<int>(polygons.size()), &is_valid, nullptr));
  if (!area || area->IsValid() != 0) return area;
  return std::unique_ptr<OGRGeometry>(area->MakeValid());
}

void add_polygons(const OGRGeometry& geometry, std::vector<PolygonRings>& polygons) {
  if (const auto* const parts = dynamic_cast<const OGRGeometryCollection*>(&geometry)) {
    for (const OGRGeometry* const part : parts) add_polygons(*part, polygons);
    return;
  }
  // Where they only touch there are points and lines.
  const auto* const polygon = dynamic_cast<const OGRPolygon*>(&geometry);
  if (polygon == nullptr || polygon->IsEmpty()) return;
  PolygonRings& rings = polygons.emplace_back();
  for (const OGRLinearRing* const ring : polygon) {
    std::vector<Point<2>>& points = rings.emplace_back(points_of(*ring));
    const bool is_outer = rings.size() == 1;
    if ((ring->isClockwise() != 0) == is_outer) std::ranges::reverse(points);
  }
}

}  // namespace

std::vector<PolygonRings> clip_with_geos(const PolygonRings& polygon, const PolygonRings& area) {
  if (!OGRGeometryFactory::haveGEOS()) {
    throw Failure("polygons are cut by GEOS, which this build of GDAL lacks: install one with it",
                  ErrorCode::kInputOutput);
  }
  forget_gdal_errors();
  const OGRPolygon whole = polygon_of(polygon);
  const std::unique_ptr<OGRGeometry> limits = area_of(area);
  if (!limits) return {};
  const std::unique_ptr<OGRGeometry> common(whole.Intersection(limits.get()));
  if (!common) {
    throw Failure(fmt::format("a polygon cannot be cut: {}", gdal_reason()), ErrorCode::kBadInput);
  }
  std::vector<PolygonRings> polygons;
  add_polygons(*common, polygons);
  return polygons;
}

}  // namespace spillway::formats

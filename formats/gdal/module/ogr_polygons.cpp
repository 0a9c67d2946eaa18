#include "formats/gdal/module/ogr_polygons.h"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "formats/gdal/module/crs.h"
#include "formats/gdal/module/gdal_errors.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Adds the rings of a polygon or of a collection of some; false if it is anything else.
bool add_rings(const OGRGeometry& geometry, PolygonRings& rings) {
  if (const auto* const parts = dynamic_cast<const OGRGeometryCollection*>(&geometry)) {
    for (const OGRGeometry* const part : parts) {
      if (!add_rings(*part, rings)) return false;
    }
    return true;
  }
  const auto* const polygon = dynamic_cast<const OGRPolygon*>(&geometry);
  if (polygon == nullptr) return false;
  for (const OGRLinearRing* const ring : polygon) rings.push_back(points_of(*ring));
  return true;
}

PolygonFeature feature_of(OGRFeature& feature, const std::string& path) {
  PolygonFeature result;
  const OGRGeometry* const geometry = feature.GetGeometryRef();
  // Arcs become short lines.
  const std::unique_ptr<OGRGeometry> linear(geometry == nullptr ? nullptr
                                                                : geometry->getLinearGeometry());
  if (!linear || !add_rings(*linear, result.rings)) {
    throw BadInput(
        path, fmt::format("feature {} is no polygon, but {}", feature.GetFID(),
                          geometry == nullptr ? "has no geometry" : geometry->getGeometryName()));
  }
  for (int f = 0; f < feature.GetFieldCount(); ++f) {
    result.fields[feature.GetFieldDefnRef(f)->GetNameRef()] = feature.GetFieldAsString(f);
  }
  return result;
}

/// What is no farther from a feature than a distance; nothing without a geometry.
PolygonFeature buffer_of(OGRFeature& feature, double distance, const std::string& path) {
  constexpr int kEdgesOfQuarterCircle = 30;
  PolygonFeature result;
  const OGRGeometry* const geometry = feature.GetGeometryRef();
  if (geometry == nullptr) return result;
  const std::unique_ptr<OGRGeometry> closed(geometry->clone());
  closed->closeRings();
  const std::unique_ptr<OGRGeometry> buffer(closed->Buffer(distance, kEdgesOfQuarterCircle));
  if (!buffer || !add_rings(*buffer, result.rings)) {
    throw BadInput(path, fmt::format("feature {} has no buffer of {}: {}", feature.GetFID(),
                                     distance, gdal_reason()));
  }
  return result;
}

/// What `read` makes of each feature of a file of one layer.
PolygonLayer read_layer(const std::string& path,
                        const std::function<PolygonFeature(OGRFeature&)>& read) {
  forget_gdal_errors();
  constexpr unsigned kHow = GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
  const GDALDatasetUniquePtr file(GDALDataset::Open(path.c_str(), kHow, nullptr, nullptr, nullptr));
  if (!file) {
    throw Failure(fmt::format("cannot read {}: {}", path, gdal_reason()), ErrorCode::kBadInput,
                  {.file = path});
  }
  if (file->GetLayerCount() != 1) {
    throw BadInput(path, fmt::format("it has {} layers, and polygons are read from one; copy that "
                                     "layer to a file of its own",
                                     file->GetLayerCount()));
  }
  OGRLayer& layer = *file->GetLayer(0);
  PolygonLayer result;
  result.crs = wkt_of_layer(layer.GetSpatialRef());
  for (const auto& feature : layer) {
    PolygonFeature polygon = read(*feature);
    if (!polygon.rings.empty()) result.polygons.push_back(std::move(polygon));
  }
  if (gdal_failed()) {
    throw Failure(fmt::format("cannot read {}: {}", path, gdal_reason()), ErrorCode::kBadInput,
                  {.file = path});
  }
  return result;
}

}  // namespace

std::vector<Point<2>> points_of(const OGRLinearRing& ring) {
  std::vector<Point<2>> points;
  points.reserve(static_cast<std::size_t>(ring.getNumPoints()));
  for (int i = 0; i < ring.getNumPoints(); ++i) points.push_back({ring.getX(i), ring.getY(i)});
  if (points.size() > 1 && points.front() == points.back()) points.pop_back();
  return points;
}

PolygonLayer read_ogr_polygons(const std::string& path) {
  PolygonLayer layer =
      read_layer(path, [&](OGRFeature& feature) { return feature_of(feature, path); });
  if (layer.polygons.empty()) throw BadInput(path, "it has no polygons");
  return layer;
}

PolygonLayer read_ogr_buffers(const std::string& path, double distance) {
  PolygonLayer layer =
      read_layer(path, [&](OGRFeature& feature) { return buffer_of(feature, distance, path); });
  if (layer.polygons.empty()) {
    throw BadInput(path, fmt::format("nothing of it is left with a buffer of {}", distance));
  }
  return layer;
}

}  // namespace spillway::formats

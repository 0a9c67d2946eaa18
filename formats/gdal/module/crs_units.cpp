#include "formats/gdal/module/crs_units.h"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <memory>
#include <numbers>

#include "formats/gdal/module/crs.h"
#include "formats/gdal/module/gdal_errors.h"

namespace spillway::formats {
namespace {

/// Metres in a unit of heights; 0 if the system tells none of heights.
double height_unit(const OGRSpatialReference& crs) {
  if (crs.IsVertical() != 0) return crs.GetTargetLinearUnits("VERT_CS", nullptr);
  // The third axis of longitude, latitude and height.
  const bool has_height = crs.IsGeographic() != 0 && crs.GetAxesCount() == 3;
  double unit = 0;
  if (has_height && crs.GetAxis(nullptr, 2, nullptr, &unit) != nullptr) return unit;
  return 0;
}

}  // namespace

CrsUnits crs_units(const std::string& crs) {
  const OGRSpatialReference parsed = parse_crs(crs);
  CrsUnits units;
  units.is_geographic = parsed.IsGeographic() != 0;
  units.horizontal = units.is_geographic ? parsed.GetAngularUnits() * 180 / std::numbers::pi
                                         : parsed.GetLinearUnits();
  units.vertical = height_unit(parsed);
  units.semi_major = parsed.GetSemiMajor();
  const double inverse = parsed.GetInvFlattening();
  units.flattening = inverse > 0 ? 1 / inverse : 0;
  return units;
}

std::string why_not_lonlat(const std::string& crs) {
  const OGRSpatialReference from = horizontal_part(parse_crs(crs));
  const OGRSpatialReference to = parse_crs("EPSG:4326");
  forget_gdal_errors();
  const std::unique_ptr<OGRCoordinateTransformation> way(
      OGRCreateCoordinateTransformation(&from, &to));
  return way ? "" : gdal_reason();
}

}  // namespace spillway::formats

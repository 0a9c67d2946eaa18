#include "stream/library/crs_notices.h"

#include <fmt/format.h>

#include "formats/gdal/crs_text.h"
#include "formats/gdal/gdal.h"
#include "src/error.h"
#include "stream/library/products/surface_units.h"

namespace spillway::stream {
namespace {

bool has(const std::string& text, const char* word) { return text.find(word) != std::string::npos; }

/// Whether x and y may be degrees, as far as that can be told without GDAL.
bool may_be_degrees(const std::string& crs, const std::optional<Box<3>>& extent) {
  if (looks_like_wkt(crs)) return !has(crs, "PROJCS[") && !has(crs, "PROJCRS[");
  return !extent || (extent->lo[0] >= -360 && extent->hi[0] <= 360 && extent->lo[1] >= -90 &&
                     extent->hi[1] <= 90);
}

/// Whether it may tell of heights.
bool may_have_heights(const std::string& crs) { return is_compound_wkt(crs) || has(crs, "+"); }

}  // namespace

void tell_units(const std::string& crs, const std::optional<Box<3>>& extent,
                const Context& context) {
  const auto& warn = context.options().warning;
  if (!warn || crs.empty() || !(may_be_degrees(crs, extent) || may_have_heights(crs))) return;
  CrsUnits units;
  std::string name;
  try {
    units = gdal().crs_units(crs);
    name = gdal().crs_name(crs);
  } catch (const Failure&) {
    return;  // GDAL is not there, or cannot read it: that is said where it matters
  }
  if (units.is_geographic) {
    warn(
        fmt::format("warning: points are in {}: x and y are degrees, which are no lengths, so the "
                    "triangulation is not that of the ground; bring points to the coordinate "
                    "system of a map",
                    name));
    return;
  }
  const double factor = z_factor_by(units);
  if (factor == 1) return;
  warn(
      fmt::format("points are in {}: heights are in units of {:.9g} m, x and y in units of {:.9g} "
                  "m; heights times {:.9g} are in those of x and y",
                  name, units.vertical, units.horizontal, factor));
}

}  // namespace spillway::stream

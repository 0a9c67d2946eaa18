#include "stream/library/crs_notices.h"

#include <fmt/format.h>

#include <string>

#include "formats/gdal/crs_text.h"
#include "formats/gdal/gdal.h"
#include "src/error.h"
#include "stream/library/products/surface_units.h"

namespace spillway::stream {
namespace {

struct Told {
  std::string name;
  CrsUnits units;
};

/// Whether GDAL is to be asked what a code means: a whole library, for a notice.
bool is_worth_asking(const std::string& code, const std::optional<Box<3>>& extent) {
  if (may_tell_heights(code)) return true;
  if (extent) {
    return extent->lo[0] >= -360 && extent->hi[0] <= 360 && extent->lo[1] >= -90 &&
           extent->hi[1] <= 90;
  }
  return code.starts_with("EPSG:4") && code.size() == 9;  // most of those in degrees
}

std::optional<Told> told_by(const std::string& crs, const std::optional<Box<3>>& extent) {
  if (looks_like_wkt(crs)) return Told{std::string(name_in_wkt(crs)), units_in_wkt(crs)};
  if (!is_worth_asking(crs, extent)) return std::nullopt;
  try {
    return Told{gdal().crs_name(crs), gdal().crs_units(crs)};
  } catch (const Failure&) {
    return std::nullopt;  // GDAL is not there, or cannot read it: that is said where it matters
  }
}

}  // namespace

void tell_units(const std::string& crs, const std::optional<Box<3>>& extent,
                const Context& context) {
  const auto& warn = context.options().warning;
  if (!warn || crs.empty()) return;
  const std::optional<Told> told = told_by(crs, extent);
  if (!told) return;
  if (told->units.is_geographic) {
    warn(
        fmt::format("warning: points are in {}: x and y are degrees, which are no lengths, so the "
                    "triangulation is not that of the ground; bring points to the coordinate "
                    "system of a map",
                    told->name));
    return;
  }
  const double factor = z_factor_by(told->units);
  if (factor == 1) return;
  warn(
      fmt::format("points are in {}: heights are in units of {:.9g} m, x and y in units of {:.9g} "
                  "m; heights times {:.9g} are in those of x and y",
                  told->name, told->units.vertical, told->units.horizontal, factor));
}

}  // namespace spillway::stream

#include "stream/library/crs_notices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <string_view>

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

/// The number in the last UNIT or LENGTHUNIT of WKT: metres, unless x and y are degrees; 0 without.
double last_unit(std::string_view wkt) {
  for (std::size_t at = wkt.rfind("UNIT["); at != wkt.npos && at > 0;
       at = wkt.rfind("UNIT[", at - 1)) {
    const std::string_view before = wkt.substr(0, at);
    const bool is_length = before.ends_with("LENGTH");
    if (!is_length && std::isalpha(static_cast<unsigned char>(before.back())) != 0) continue;
    const std::size_t quote = wkt.find('"', wkt.find('"', at) + 1);
    const std::size_t comma = wkt.find(',', quote);
    if (comma == wkt.npos) return 0;
    const std::size_t begin = wkt.find_first_not_of(' ', comma + 1);
    if (begin == wkt.npos) return 0;
    double unit = 0;
    const auto [end, fault] = std::from_chars(wkt.data() + begin, wkt.data() + wkt.size(), unit);
    return fault == std::errc() ? unit : 0;
  }
  return 0;
}

Told told_by_wkt(std::string_view wkt) {
  Told told;
  const std::size_t quote = std::min(wkt.find('"'), wkt.size());
  told.name = wkt.substr(std::min(quote + 1, wkt.size()), wkt.find('"', quote + 1) - quote - 1);
  const auto has = [&](std::string_view word) { return wkt.find(word) != wkt.npos; };
  told.units.is_geographic =
      (has("GEOGCS[") || has("GEOGCRS[")) && !has("PROJCS[") && !has("PROJCRS[");
  const std::size_t heights = std::min(wkt.find("VERT_CS["), wkt.find("VERTCRS["));
  if (heights != wkt.npos) {
    told.units.horizontal = last_unit(wkt.substr(0, heights));
    told.units.vertical = last_unit(wkt.substr(heights));
  }
  return told;
}

/// Whether GDAL is to be asked what a code means: a whole library, for a notice.
bool is_worth_asking(const std::string& code, const std::optional<Box<3>>& extent) {
  if (code.find('+') != code.npos) return true;  // it may tell of heights
  if (extent) {
    return extent->lo[0] >= -360 && extent->hi[0] <= 360 && extent->lo[1] >= -90 &&
           extent->hi[1] <= 90;
  }
  return code.starts_with("EPSG:4") && code.size() == 9;  // most of those in degrees
}

std::optional<Told> told_by(const std::string& crs, const std::optional<Box<3>>& extent) {
  if (looks_like_wkt(crs)) return told_by_wkt(crs);
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

#pragma once
// The coordinate system as GeoTIFF keys tell it, which is how LAS files before 1.4 do. Source: OGC,
// "GeoTIFF Standard" 1.1 (19-008r4); docs/formats-points.md ("LAS") says what is made of them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/gdal/gdal.h"

namespace spillway::formats {

/// Codes of EPSG are below it; as a value it means that other keys define the system.
inline constexpr std::uint16_t kGeotiffUserDefined = 32767;

/// What keys say of the coordinate system.
struct GeotiffCrs {
  std::string crs;   ///< "EPSG:n"; empty if the keys tell none for certain
  std::string note;  ///< why they do not, or what is left out of what they tell; empty: nothing
  bool has_more = false;  ///< besides `crs` they tell a system of heights: whole_geotiff_crs()
};

/// Reads keys. Only what is certain is a system: codes that contradict the model, as EPSG knows
/// them, or the unit are none, and so are codes that GDAL does not know. It is asked where the
/// codes alone do not tell, and for systems that keys define by parameters; where its module is not
/// installed, the keys of a projected or geographic system are believed.
GeotiffCrs read_geotiff_keys(const GeotiffKeys& keys);

/// `crs`, which read_geotiff_keys() has found, with the system of heights that the keys tell, if
/// GDAL makes one of them. Throws Failure if GDAL is not there.
std::string whole_geotiff_crs(const std::string& crs, const GeotiffKeys& keys);

/// A note: the text of a coordinate system is none; and what that means, if there is more to say.
std::string unreadable_crs(std::string_view text, std::string_view and_so);

/// What kind of system a code of EPSG is: known for some ranges, else GDAL is asked; nothing if its
/// module is not installed.
std::optional<CrsKind> kind_of_epsg(std::uint16_t code);

/// A directory that says no more than what kind of system an EPSG code is, and the code. `kind` is
/// not CrsKind::kOther.
std::vector<std::byte> geotiff_keys_of(std::uint16_t code, CrsKind kind);

}  // namespace spillway::formats

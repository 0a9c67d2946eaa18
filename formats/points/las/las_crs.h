#pragma once
// The coordinate system in LAS files, as docs/formats-points.md ("LAS, written") describes it.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "src/rooms.h"

namespace spillway::formats {

/// Bit of the global encoding: the coordinate system is WKT.
inline constexpr std::uint16_t kLasWktBit = 0x10;

/// What a LAS header has to tell of a coordinate system.
struct LasCrs {
  std::uint32_t records = 0;       ///< variable length records in `bytes`
  std::vector<std::byte> bytes{};  ///< those records, with their headers
  bool wkt_bit = false;
};

/// Puts a coordinate system (WKT or "EPSG:n"; "": none) into records. `wkt` is the same as WKT
/// where the caller knows it. LAS 1.4 gets the WKT, 1.2 the GeoTIFF key of the EPSG code, and the
/// WKT beside it if that is what `crs` is. Throws Failure if LAS cannot hold it.
LasCrs las_crs(const std::string& crs, const std::string& wkt, bool version14);

}  // namespace spillway::formats

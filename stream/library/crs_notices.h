#pragma once

#include <spillway/context.h>

#include <optional>
#include <string>

#include "src/geometry/box.h"

namespace spillway::stream {

/// Warns if points that are triangulated lie in longitude and latitude, as degrees are no lengths,
/// and says if heights have another unit than x and y. GDAL is asked only of codes, where the
/// extent leaves it open. `crs` as of the points; empty: nothing is known.
void tell_units(const std::string& crs, const std::optional<Box<3>>& extent,
                const Context& context);

}  // namespace spillway::stream

#pragma once

#include <spillway/context.h>

#include <string>

#include "stream/source/source_crs.h"

namespace spillway::stream {

/// A coordinate system that a caller gives, on one line: codes as they are, else WKT. Throws Failure
/// if GDAL cannot read it, or is not there.
std::string checked_crs(const std::string& crs);

/// The system of a mesh of that name, which tells one or none, as an output needs it: as
/// find_crs() and settled_crs() have it.
std::string crs_of_mesh(const std::string& name, const std::string& told, const CrsChoice& choice,
                        CrsNeed need, const Context& context);

}  // namespace spillway::stream

#pragma once

#include <optional>
#include <string>

#include "formats/gdal/gdal.h"

namespace spillway::stream {

/// Throws Failure(kInvalidArgument) unless heights may be multiplied by it.
void check_z_factor(const std::optional<double>& factor);

/// What brings heights to the unit of x and y, which are lengths; 1 if heights have no unit of their
/// own.
double z_factor_by(const CrsUnits& units);

/// Throws Failure(kBadInput) about `file` if `name` and `other` have different coordinate systems.
/// What tells none ("") has that of the other.
void check_same_crs(const std::string& name, const std::string& crs, const std::string& other,
                    const std::string& other_crs, const std::string& file);

}  // namespace spillway::stream

#pragma once

#include <string>

#include "src/rooms.h"

namespace spillway::formats {

/// Keeps GDAL from printing on standard error; to be called once, when the module is loaded.
void silence_gdal();

/// Forgets what GDAL has complained of in this thread.
void forget_gdal_errors();

/// The first failure that GDAL has complained of in this thread since they were forgotten, in one
/// line; "GDAL gives no reason" if it said nothing.
std::string gdal_reason();

/// Whether GDAL has complained of a failure in this thread since they were forgotten.
bool gdal_failed();

}  // namespace spillway::formats

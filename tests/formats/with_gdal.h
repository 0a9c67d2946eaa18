#pragma once

#include <string>

#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway::test {

/// Whether this build has GDAL, for tests that skip what takes it. A module that cannot be loaded
/// is no reason to skip.
inline bool with_gdal() {
  try {
    (void)gdal();
  } catch (const Failure& error) {
    return std::string(error.what()).find("which this build") == std::string::npos;
  }
  return true;
}

}  // namespace spillway::test

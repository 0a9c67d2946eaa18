#pragma once

#include <memory>
#include <string>

#include "formats/gdal/gdal.h"

namespace spillway::formats {

/// As Gdal::create_transform().
std::unique_ptr<CrsTransform> create_proj_transform(const std::string& from, const std::string& to);

}  // namespace spillway::formats

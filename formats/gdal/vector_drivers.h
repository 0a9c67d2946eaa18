#pragma once
// Vector files through OGR, within the module.

#include <memory>
#include <string>
#include <vector>

#include "formats/gdal/vector_layer.h"

namespace spillway::formats {

/// What Gdal::create_layer() returns.
std::unique_ptr<VectorLayer> create_ogr_layer(const VectorLayerOptions& options);

/// What Gdal::open_layer() returns.
std::unique_ptr<TriangleLayer> open_ogr_layer(const std::string& path);

/// What Gdal::table_names() returns.
std::vector<std::string> geopackage_tables(const std::string& path);

}  // namespace spillway::formats

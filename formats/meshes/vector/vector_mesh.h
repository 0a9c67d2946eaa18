#pragma once
// Meshes in GeoPackage and Shapefile: one polygon with z for each triangle.

#include <memory>
#include <string>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_stream.h"
#include "formats/vectors/vector_formats.h"

namespace spillway::formats {

/// Begins to write triangles to `path`. The lattice goes into a GeoPackage's
/// metadata; a shapefile cannot hold it. Throws Failure if the file cannot be created.
std::unique_ptr<MeshStreamWriter> open_vector_mesh_writer(const std::string& path,
                                                          const VectorFormat& format,
                                                          const MeshStreamHeader& header);

/// Reads the triangles of a GeoPackage or Shapefile of one layer; equal corners become one vertex.
/// Throws Failure that names the file and the feature.
Mesh read_vector_mesh(const std::string& path);

}  // namespace spillway::formats

#pragma once

#include <optional>
#include <string>

#include "formats/bytes/input_source.h"
#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_writer.h"

namespace spillway::detail {

/// The format of meshes that the first bytes tell of; nothing if they are not those of a mesh.
std::optional<MeshFormat> mesh_format_of_content(InputSource& source);

/// True if the file holds a mesh rather than points, judged by its first bytes ("-" is never
/// probed) and, for formats that begin with nothing of their own, by its name.
bool is_mesh(FileSystem& files, const std::string& path);

/// Reads a whole mesh: PLY (binary or ASCII, either byte order), OBJ, OFF, VTU as Spillway writes
/// it (appended raw, UInt64 headers, uncompressed), npy pairs (`X_vertices.npy` beside
/// `X_simplices.npy`, either name, or `X.npy` where no file has that name itself), binary glTF, STL
/// (binary or ASCII), LandXML, triangles in a GeoPackage or Shapefile (on the machine's own disk,
/// as GDAL reads them), and the streams spm and sma. `format_name` is one of mesh_format_names();
/// if it is empty, the first bytes tell, then the name. Checked before anything is allocated:
/// counts against the file's size, vertex numbers against the vertex count. Coordinates are finite.
/// Throws Error that names the file and the byte or line.
Mesh read_mesh(FileSystem& files, const std::string& path, const std::string& format_name = "");

}  // namespace spillway::detail

#pragma once

#include <cstdint>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/compression/expansion.h"
#include "formats/disk/file_system.h"
#include "formats/meshes/mesh_formats.h"

namespace spillway::formats {

/// The format of meshes that the first bytes tell of; null if they are not those of a mesh.
const MeshFormat* mesh_format_of_content(InputBytes& source, MeshFormats formats = mesh_formats());

/// True if the file holds a mesh rather than points, judged by its first bytes ("-" is never
/// probed) and, for formats that begin with nothing of their own, by its name.
bool is_mesh(FileSystem& files, const std::string& path, MeshFormats formats = mesh_formats());

/// Reads a whole mesh, in any of the formats, streams included. docs/formats-meshes.md tells what
/// is read of each: of npy pairs (`X_vertices.npy` beside `X_simplices.npy`) by either name or as
/// `X.npy`, of tables those on the machine's own disk. `format_name` is a format's name; if it is
/// empty, the first bytes tell, then the path. Checked before anything is allocated: counts against
/// the file's size, vertex numbers against the vertex count. Coordinates are finite. No compressed
/// block expands_too_far() by `max_expansion`. Throws Failure that names the file and the byte or
/// line.
Mesh read_mesh(FileSystem& files, const std::string& path, const std::string& format_name = "",
               MeshFormats formats = mesh_formats(), std::uint64_t max_expansion = kMostExpansion);

/// The whole of a stream of which nothing has been read, in output coordinates.
Mesh collect_mesh(MeshStreamReader& stream);

}  // namespace spillway::formats

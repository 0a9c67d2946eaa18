#pragma once
// A mesh as npy arrays side by side: X_vertices.npy, X_simplices.npy and, where there are some,
// X_input_index.npy, X_attributes.npy and, of a periodic mesh, X_offsets.npy and X_box.npy, for a
// mesh called X.npy. Layout: docs/formats-meshes.md ("npy").

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh_format.h"

namespace spillway::formats {

/// How the name of the file with a mesh's simplices ends.
inline constexpr std::string_view kNpySimplices = "_simplices.npy";

/// The files of an npy mesh.
struct NpyMeshNames {
  std::string vertices;
  std::string simplices;
  std::string input_index;
  std::string attributes;
  std::string offsets;
  std::string box;
};

/// The files that `path` stands for when a mesh is written: X.npy or X.
NpyMeshNames npy_mesh_names(const std::string& path);

/// The files of the mesh that `path` stands for when it is read: X_vertices.npy, X_simplices.npy,
/// X.npy or X. Nothing unless the files of vertices and simplices are both there.
std::optional<NpyMeshNames> find_npy_mesh(const FileSystem& files, const std::string& path);

/// Whether `path` is one of the files of a mesh whose vertices and simplices are both there.
bool is_part_of_npy_mesh(const FileSystem& files, const std::string& path);

/// The names of the files that the mesh `path` is written to. Throws Failure for standard output, and
/// if an input index, attributes, offsets or a box of an earlier mesh would lie beside a mesh that
/// has none.
NpyMeshNames npy_mesh_to_write(const FileSystem& files, const std::string& path,
                               const MeshContents& contents);

/// Writes a mesh to `files`, which create_mesh_files() made.
std::unique_ptr<MeshWriter> open_npy_mesh_writer(MeshFiles files, const MeshFileHeader& header);

/// Reads the mesh. Throws Failure that names the file and the byte.
Mesh read_npy_mesh(FileSystem& files, const NpyMeshNames& names);

}  // namespace spillway::formats

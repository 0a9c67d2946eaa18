#include "formats/meshes/create_mesh.h"

#include <fmt/format.h>

#include <utility>

#include "formats/meshes/glb/glb_writer.h"
#include "formats/meshes/landxml/landxml_writer.h"
#include "formats/meshes/mesh_format.h"
#include "formats/meshes/npy/npy_mesh.h"
#include "formats/meshes/obj/obj_writer.h"
#include "formats/meshes/off/off_writer.h"
#include "formats/meshes/ply/ply_writer.h"
#include "formats/meshes/vtu/vtu_writer.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

/// Throws InvalidArgument if the format, of triangles only, cannot hold the mesh.
void check_triangles_only(const std::string& path, std::string_view format, int dimension,
                          bool has_input_index) {
  if (dimension != 2) {
    throw InvalidArgument(fmt::format(
        "cannot write {}: {} holds no tetrahedra; choose spm, ply, vtu or npy", path, format));
  }
  if (has_input_index) {
    throw InvalidArgument(
        fmt::format("cannot write {}: {} holds no input index; choose spm, ply, vtu or npy, or "
                    "leave the index out",
                    path, format));
  }
}

bool needs_regular_file(MeshFormat format) {
  return format == MeshFormat::kGlb || format == MeshFormat::kStl || format == MeshFormat::kGpkg ||
         format == MeshFormat::kShp;
}

}  // namespace

MeshFiles create_mesh_files(FileSystem& files, const std::string& path, MeshFormat format,
                            int dimension, bool has_input_index) {
  MeshFiles created;
  created.format = format;
  if (const std::string_view name = triangle_format(format); !name.empty()) {
    check_triangles_only(path, name, dimension, has_input_index);
  }
  if (path == "-" && needs_regular_file(format)) {
    throw InvalidArgument(
        fmt::format("standard output cannot take {}, whose begin is written last; name a "
                    "file",
                    triangle_format(format)));
  }
  if (format == MeshFormat::kGpkg || format == MeshFormat::kShp) return created;
  if (format == MeshFormat::kNpy) {
    const NpyMeshNames names = npy_mesh_to_write(files, path, has_input_index);
    created.main = files.create(names.vertices);
    created.simplices = files.create(names.simplices);
    if (has_input_index) created.input_index = files.create(names.input_index);
    return created;
  }
  created.main = files.create(path);
  return created;
}

std::unique_ptr<MeshWriter> open_mesh_writer(MeshFiles files, const MeshHeader& header) {
  switch (files.format) {
    case MeshFormat::kPly:
    case MeshFormat::kPlyAscii:
      return open_ply_writer(std::move(files.main), header, files.format == MeshFormat::kPlyAscii);
    case MeshFormat::kObj:
      return open_obj_writer(std::move(files.main), header);
    case MeshFormat::kOff:
      return open_off_writer(std::move(files.main), header);
    case MeshFormat::kVtu:
      return open_vtu_writer(std::move(files.main), header);
    case MeshFormat::kNpy:
      return open_npy_mesh_writer(std::move(files), header);
    case MeshFormat::kGlb:
      return open_glb_writer(std::move(files.main), header);
    case MeshFormat::kLandXml:
      return open_landxml_writer(std::move(files.main), header);
    default:
      throw Error("this mesh format is written block by block, not as a whole mesh");
  }
}

std::unique_ptr<MeshWriter> open_mesh_writer(FileSystem& files, const std::string& path,
                                             MeshFormat format, const MeshHeader& header) {
  return open_mesh_writer(
      create_mesh_files(files, path, format, header.dimension, header.has_input_index), header);
}

}  // namespace spillway::detail

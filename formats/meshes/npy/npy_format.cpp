#include "formats/meshes/npy/npy_format.h"

#include <fmt/format.h>

#include <optional>

#include "formats/bytes/bytes.h"
#include "formats/meshes/npy/npy_mesh.h"
#include "formats/points/npy/npy_header.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"npy"};

bool is_meant(const FileSystem& files, const std::string& path) {
  const std::optional<NpyMeshNames> names = find_npy_mesh(files, path);
  return names && (path == names->vertices || path == names->simplices || !files.exists(path));
}

void check_is_points(const FileSystem& files, const std::string& path) {
  if (!path.ends_with(kNpySimplices) || !is_part_of_npy_mesh(files, path)) return;
  throw BadInput(path,
                 "these are the simplices of an npy mesh, not points; its vertices are in a file "
                 "beside it");
}

void check_is_no_part(InputBytes& source, const std::string& path) {
  if (!as_text(source.peek(kNpyMagic.size())).starts_with(kNpyMagic)) return;
  const NpyMeshNames names = npy_mesh_names(path);
  throw BadInput(
      source.name(),
      fmt::format("this is one npy array, but a mesh is two, such as {} and {}; name one "
                  "of these",
                  names.vertices, names.simplices));
}

Mesh read(FileSystem& files, const std::string& path) {
  if (const std::optional<NpyMeshNames> names = find_npy_mesh(files, path)) {
    return read_npy_mesh(files, *names);
  }
  const NpyMeshNames names = npy_mesh_names(path);
  throw BadInput(
      path, fmt::format("an npy mesh is two files, such as {} and {}, which are not both there",
                        names.vertices, names.simplices));
}

MeshFiles create(FileSystem& files, const std::string& path, const MeshContents& contents) {
  const NpyMeshNames names = npy_mesh_to_write(files, path, contents);
  MeshFiles created;
  created.main = files.create(names.vertices);
  created.simplices = files.create(names.simplices);
  if (contents.has_input_index) created.input_index = files.create(names.input_index);
  if (contents.has_attributes) created.attributes = files.create(names.attributes);
  if (contents.is_periodic) {
    created.offsets = files.create(names.offsets);
    created.box = files.create(names.box);
  }
  return created;
}

std::string names_in_words(const std::string& path) {
  const NpyMeshNames names = npy_mesh_names(path);
  return names.vertices + " and " + names.simplices;
}

constexpr MeshFileSet kFileSet = {.is_meant = is_meant,
                                  .has_part = is_part_of_npy_mesh,
                                  .check_is_points = check_is_points,
                                  .check_is_no_part = check_is_no_part,
                                  .read = read,
                                  .create = create,
                                  .names = names_in_words};

}  // namespace

constinit const MeshFormat kNpyMesh = {
    .name = "npy",
    .title = "npy",
    .extensions = kExtensions,
    .name_tells = false,
    .most_dimension = 6,
    .holds_input_index = true,
    .held_attributes = HeldAttributes::kAll,
    .holds_offsets = true,
    .open_writer = open_npy_mesh_writer,
    .file_set = &kFileSet,
};

}  // namespace spillway::formats

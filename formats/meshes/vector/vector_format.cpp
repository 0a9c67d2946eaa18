#include "formats/meshes/vector/vector_format.h"

#include "formats/meshes/vector/vector_mesh.h"
#include "formats/vectors/vector_formats.h"

namespace spillway::formats {
namespace {

// A GeoPackage is a SQLite database.
constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
constexpr std::string_view kShapefileMagic("\x00\x00\x27\x0a", 4);

}  // namespace

constinit const MeshFormat kGpkgMesh = {
    .name = kGeoPackage.name,
    .title = kGeoPackage.title,
    .extensions = kGeoPackage.extensions,
    .needs_regular_file = true,
    .reads_crs = true,
    .recognises = [](std::string_view text) { return text.starts_with(kSqliteMagic); },
    .read_table = read_vector_mesh,
    .open_block_writer =
        [](MeshFiles files, const MeshStreamHeader& header) {
          return open_vector_mesh_writer(files.path, kGeoPackage, header);
        },
};

constinit const MeshFormat kShpMesh = {
    .name = kShapefile.name,
    .title = kShapefile.title,
    .extensions = kShapefile.extensions,
    .needs_regular_file = true,
    .reads_crs = true,
    .recognises = [](std::string_view text) { return text.starts_with(kShapefileMagic); },
    .read_table = read_vector_mesh,
    .open_block_writer =
        [](MeshFiles files, const MeshStreamHeader& header) {
          return open_vector_mesh_writer(files.path, kShapefile, header);
        },
};

}  // namespace spillway::formats

#include "formats/meshes/ply/ply_format.h"

#include <utility>

#include "formats/meshes/common/mesh_checks.h"
#include "formats/meshes/ply/ply_header.h"
#include "formats/meshes/ply/ply_reader.h"
#include "formats/meshes/ply/ply_writer.h"

namespace spillway::detail {
namespace {

constexpr std::string_view kExtensions[] = {"ply"};
constexpr std::string_view kAsciiExtensions[] = {"ply-ascii"};

}  // namespace

constinit const MeshFormat kPlyMesh = {
    .name = "ply",
    .title = "PLY",
    .extensions = kExtensions,
    .holds_tetrahedra = true,
    .holds_input_index = true,
    .stands_in_parts = true,
    .recognises = [](std::string_view text) { return begins_with_word(text, "ply"); },
    .has_simplices =
        [](InputBytes& source) { return read_ply_header(source).simplices() != nullptr; },
    .read = read_ply,
    .open_writer =
        [](MeshFiles files, const MeshHeader& header) {
          return open_ply_writer(std::move(files.main), header, false);
        },
};

constinit const MeshFormat kPlyAsciiMesh = {
    .name = "ply-ascii",
    .title = "PLY",
    .extensions = kAsciiExtensions,
    .name_tells = false,
    .is_variant = true,
    .holds_tetrahedra = true,
    .holds_input_index = true,
    .read = read_ply,
    .open_writer =
        [](MeshFiles files, const MeshHeader& header) {
          return open_ply_writer(std::move(files.main), header, true);
        },
};

}  // namespace spillway::detail

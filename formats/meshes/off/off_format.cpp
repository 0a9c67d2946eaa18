#include "formats/meshes/off/off_format.h"

#include <utility>

#include "formats/meshes/common/mesh_checks.h"
#include "formats/meshes/off/off_reader.h"
#include "formats/meshes/off/off_writer.h"

namespace spillway::detail {
namespace {

constexpr std::string_view kExtensions[] = {"off"};

}  // namespace

constinit const MeshFormat kOffMesh = {
    .name = "off",
    .title = "OFF",
    .extensions = kExtensions,
    .recognises = [](std::string_view text) { return begins_with_word(text, "OFF"); },
    .read = read_off,
    .open_writer =
        [](MeshFiles files, const MeshHeader& header) {
          return open_off_writer(std::move(files.main), header);
        },
};

}  // namespace spillway::detail

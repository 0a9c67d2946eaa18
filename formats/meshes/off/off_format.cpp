#include "formats/meshes/off/off_format.h"

#include <cstdint>
#include <utility>

#include "formats/meshes/off/off_kind.h"
#include "formats/meshes/off/off_reader.h"
#include "formats/meshes/off/off_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"off"};

}  // namespace

constinit const MeshFormat kOffMesh = {
    .name = "off",
    .title = "OFF",
    .extensions = kExtensions,
    .recognises = [](std::string_view text) { return off_kind_of_text(text).has_value(); },
    .read = [](InputBytes& source, std::uint64_t) { return read_off(source); },
    .open_writer =
        [](MeshFiles files, const MeshFileHeader& header) {
          return open_off_writer(std::move(files.main), header);
        },
};

}  // namespace spillway::formats

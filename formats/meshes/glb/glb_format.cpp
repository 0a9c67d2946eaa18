#include "formats/meshes/glb/glb_format.h"

#include <cstdint>
#include <utility>

#include "formats/meshes/glb/glb_reader.h"
#include "formats/meshes/glb/glb_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"glb"};

}  // namespace

constinit const MeshFormat kGlbMesh = {
    .name = "glb",
    .title = "glTF",
    .extensions = kExtensions,
    .held_attributes = HeldAttributes::kColour,
    .rounds_coordinates = true,
    .needs_regular_file = true,
    .recognises = [](std::string_view text) { return text.starts_with(glb::kMagic); },
    .read = [](InputBytes& source, std::uint64_t) { return read_glb(source); },
    .open_writer =
        [](MeshFiles files, const MeshFileHeader& header) {
          return open_glb_writer(std::move(files.main), header);
        },
};

}  // namespace spillway::formats

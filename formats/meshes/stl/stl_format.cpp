#include "formats/meshes/stl/stl_format.h"

#include <cstdint>
#include <utility>

#include "formats/meshes/stl/stl_reader.h"
#include "formats/meshes/stl/stl_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"stl"};

}  // namespace

constinit const MeshFormat kStlMesh = {
    .name = "stl",
    .title = "STL",
    .extensions = kExtensions,
    .rounds_coordinates = true,
    .needs_regular_file = true,
    .recognises =
        [](std::string_view text) {
          return text.starts_with(kStlOrigin) || looks_like_ascii_stl(text);
        },
    .unknown_origin = stl_origin,
    .read = [](InputBytes& source, std::uint64_t) { return read_stl(source); },
    .open_block_writer =
        [](MeshFiles files, const MeshStreamHeader& header) {
          return open_stl_writer(std::move(files.main), header);
        },
};

}  // namespace spillway::formats

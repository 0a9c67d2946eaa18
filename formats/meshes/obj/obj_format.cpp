#include "formats/meshes/obj/obj_format.h"

#include <cstdint>
#include <utility>

#include "formats/bytes/fields.h"
#include "formats/meshes/obj/obj_reader.h"
#include "formats/meshes/obj/obj_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"obj"};

// Of OBJ, which has no magic number, only Spillway's own is recognised.
constexpr std::string_view kFirstWords = "# spillway dimension";

}  // namespace

constinit const MeshFormat kObjMesh = {
    .name = "obj",
    .title = "OBJ",
    .extensions = kExtensions,
    .recognises = [](std::string_view text) { return begins_with_word(text, kFirstWords); },
    .read = [](InputBytes& source, std::uint64_t) { return read_obj(source); },
    .open_writer =
        [](MeshFiles files, const MeshFileHeader& header) {
          return open_obj_writer(std::move(files.main), header);
        },
};

}  // namespace spillway::formats

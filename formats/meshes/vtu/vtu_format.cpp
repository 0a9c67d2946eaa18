#include "formats/meshes/vtu/vtu_format.h"

#include <cstdint>
#include <utility>

#include "formats/meshes/vtu/vtu_index.h"
#include "formats/meshes/vtu/vtu_reader.h"
#include "formats/meshes/vtu/vtu_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"vtu"};
constexpr MeshPartIndex kIndex = {.extension = "pvtu", .text = pvtu_text};

}  // namespace

constinit const MeshFormat kVtuMesh = {
    .name = "vtu",
    .title = "VTU",
    .extensions = kExtensions,
    .most_dimension = 3,
    .holds_input_index = true,
    .held_attributes = HeldAttributes::kAll,
    .holds_offsets = true,
    .stands_in_parts = true,
    .recognises =
        [](std::string_view text) {
          return text.starts_with('<') && text.find("<VTKFile") != text.npos;
        },
    .read =
        [](InputBytes& source, std::uint64_t max_expansion) {
          check_is_no_pvtu(source);
          return read_vtu(source, max_expansion);
        },
    .open_writer =
        [](MeshFiles files, const MeshFileHeader& header) {
          return open_vtu_writer(std::move(files.main), header);
        },
    .part_index = &kIndex,
};

}  // namespace spillway::formats

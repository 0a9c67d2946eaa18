#include "formats/meshes/ply/ply_format.h"

#include <cstdint>
#include <utility>

#include "formats/meshes/ply/ply_reader.h"
#include "formats/meshes/ply/ply_records.h"
#include "formats/meshes/ply/ply_writer.h"
#include "formats/ply/ply_header.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"ply"};
constexpr std::string_view kAsciiExtensions[] = {"ply-ascii"};

constexpr MeshRecords kRecords = {
    .header = [](const MeshFileHeader& header,
                 const std::string& name) { return ply_header_text(header, false, name); },
    .attributes = ply_vertex_records,
    .vertex_size =
        [](const MeshFileHeader& header) {
          return ply_vertex_size(header.has_input_index ? 1 : 0) +
                 ply_vertex_layout(header.attributes).record_size();
        },
    .simplex_size = ply_simplex_size,
    .put_vertex =
        [](std::byte* at, const WorldPoint& vertex, const std::optional<std::uint64_t>& input_index,
           std::span<const std::byte> record, const std::string& name) {
          const double index = input_index ? ply_index(*input_index, name) : 0;
          return put_ply_vertex(at, vertex, std::span(&index, input_index ? 1 : 0), record);
        },
    .put_simplex = put_ply_simplex,
};

}  // namespace

constinit const MeshFormat kPlyMesh = {
    .name = "ply",
    .title = "PLY",
    .extensions = kExtensions,
    .most_dimension = 3,
    .holds_input_index = true,
    .held_attributes = HeldAttributes::kAll,
    .takes_colour = true,
    .stands_in_parts = true,
    .recognises = begins_as_ply,
    .has_simplices =
        [](InputBytes& source) { return peek_ply_header(source).simplices() != nullptr; },
    .read = [](InputBytes& source, std::uint64_t) { return read_ply(source); },
    .open_writer =
        [](MeshFiles files, const MeshFileHeader& header) {
          return open_ply_writer(std::move(files.main), header, false);
        },
    .records = &kRecords,
};

constinit const MeshFormat kPlyAsciiMesh = {
    .name = "ply-ascii",
    .title = "PLY",
    .extensions = kAsciiExtensions,
    .name_tells = false,
    .is_variant = true,
    .most_dimension = 3,
    .holds_input_index = true,
    .held_attributes = HeldAttributes::kAll,
    .takes_colour = true,
    .read = [](InputBytes& source, std::uint64_t) { return read_ply(source); },
    .open_writer =
        [](MeshFiles files, const MeshFileHeader& header) {
          return open_ply_writer(std::move(files.main), header, true);
        },
};

}  // namespace spillway::formats

#include "formats/meshes/spm/spm_format.h"

#include <utility>

#include "formats/meshes/spm/spm_reader.h"
#include "formats/meshes/spm/spm_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"spm"};

}  // namespace

constinit const MeshFormat kSpmMesh = {
    .name = "spm",
    .title = "spm",
    .extensions = kExtensions,
    .most_dimension = 6,
    .holds_input_index = true,
    .held_attributes = HeldAttributes::kAll,
    .holds_offsets = true,
    .stands_in_parts = true,
    .has_totals = true,
    .recognises = [](std::string_view text) { return text.starts_with(kSpmMagic); },
    .open_stream = open_spm_reader,
    .open_block_writer =
        [](MeshFiles files, const MeshStreamHeader& header) {
          return open_spm_writer(std::move(files.main), header);
        },
};

}  // namespace spillway::formats

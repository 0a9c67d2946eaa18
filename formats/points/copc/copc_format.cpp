#include "formats/points/copc/copc_format.h"

#include <utility>

#include "formats/points/copc/copc_reader.h"
#include "formats/points/copc/copc_writer.h"
#include "formats/points/las/las_variant.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"copc.laz"};

constexpr LasVariant kVariant = {
    .is_told = [](const LasHeader& las) { return las.copc.has_value(); }, .open = open_copc_reader};

}  // namespace

constinit const PointFormat kCopcPoints = {
    .name = "copc",
    .title = "COPC",
    .extensions = kExtensions,
    .holds_crs = true,
    .wants_wkt = true,
    .holds_attributes = true,
    .drops_waveforms = true,
    .needs_heights = true,
    .needs_lattice = true,
    .has_versions = true,
    .has_levels = true,
    .las_variant = &kVariant,
    .open_writer =
        [](std::unique_ptr<OutputFile> file, const std::string& /*path*/,
           const PointWriterOptions& options) {
          return open_copc_writer(std::move(file), options);
        },
    .header_comes_last = [](const PointWriterOptions& /*options*/) { return true; },
};

}  // namespace spillway::formats

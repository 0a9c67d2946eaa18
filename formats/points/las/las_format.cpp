#include "formats/points/las/las_format.h"

#include <utility>

#include "formats/points/las/las_reader.h"
#include "formats/points/las/las_variant.h"
#include "formats/points/las/las_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"las"};

constexpr LasVariant kVariant = {
    .is_told = [](const LasHeader& las) { return !las.laz && !las.copc; }, .open = open_las_reader};

}  // namespace

constinit const PointFormat kLasPoints = {
    .name = "las",
    .title = "LAS",
    .extensions = kExtensions,
    .holds_crs = true,
    .wants_wkt = true,
    .holds_attributes = true,
    .needs_heights = true,
    .needs_lattice = true,
    .has_versions = true,
    .recognises = [](std::string_view text) { return text.starts_with("LASF"); },
    .las_variant = &kVariant,
    .open_writer =
        [](std::unique_ptr<OutputFile> file, const std::string& /*path*/,
           const PointWriterOptions& options) { return open_las_writer(std::move(file), options); },
    .header_comes_last =
        [](const PointWriterOptions& options) {
          return !options.count || !options.attributes.empty();
        },
};

}  // namespace spillway::formats

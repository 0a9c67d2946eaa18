#include "formats/points/laz/laz_format.h"

#include <utility>

#include "formats/points/las/las_variant.h"
#include "formats/points/laz/laz_reader.h"
#include "formats/points/laz/laz_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"laz"};

constexpr LasVariant kVariant = {
    .is_told = [](const LasHeader& las) { return las.laz && !las.copc; },
    .open =
        [](std::unique_ptr<InputBytes> source, const LasHeader& las, const std::string& path,
           const PointReaderOptions& options) {
          return open_laz_reader(std::move(source), las, path, options);
        }};

}  // namespace

constinit const PointFormat kLazPoints = {
    .name = "laz",
    .title = "LAZ",
    .extensions = kExtensions,
    .holds_crs = true,
    .wants_wkt = true,
    .holds_attributes = true,
    .needs_heights = true,
    .needs_lattice = true,
    .has_versions = true,
    .las_variant = &kVariant,
    .open_writer =
        [](std::unique_ptr<OutputFile> file, const std::string& /*path*/,
           const PointWriterOptions& options) { return open_laz_writer(std::move(file), options); },
    .header_comes_last =
        [](const PointWriterOptions& options) {
          return !options.count || !options.attributes.empty();
        },
};

}  // namespace spillway::formats

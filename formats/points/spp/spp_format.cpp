#include "formats/points/spp/spp_format.h"

#include <utility>

#include "formats/points/spp/spp_reader.h"
#include "formats/points/spp/spp_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"spp"};

}  // namespace

constinit const PointFormat kSppPoints = {
    .name = "spp",
    .title = "spp",
    .extensions = kExtensions,
    .holds_crs = true,
    .holds_attributes = true,
    .holds_regions = true,
    .largest_integer = 0x1p53,
    .recognises = [](std::string_view text) { return text.starts_with(kSppMagic); },
    .open_reader =
        [](PointInput input, const PointReaderOptions& /*options*/) {
          return open_spp_reader(std::move(input.source), input.path);
        },
    .open_writer =
        [](std::unique_ptr<OutputFile> file, const std::string& /*path*/,
           const PointWriterOptions& options) { return open_spp_writer(std::move(file), options); },
};

}  // namespace spillway::formats

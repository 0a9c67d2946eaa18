#include "formats/points/ply/ply_format.h"

#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/ply/ply_header.h"
#include "formats/points/ply/ply_reader.h"
#include "formats/points/ply/ply_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"ply"};
constexpr std::size_t kProbe = 8;

}  // namespace

constinit const PointFormat kPlyPoints = {
    .name = "ply",
    .title = "PLY",
    .extensions = kExtensions,
    .holds_crs = true,
    .holds_attributes = true,
    .has_points =
        [](InputBytes& source) {
          return begins_as_ply(as_text(source.peek(kProbe))) &&
                 peek_ply_header(source).simplices() == nullptr;
        },
    .open_reader =
        [](PointInput input, const PointReaderOptions& options) {
          return open_ply_points(std::move(input.source), input.path, options.skip_invalid);
        },
    .open_writer =
        [](std::unique_ptr<OutputFile> file, const std::string& /*path*/,
           const PointWriterOptions& options) {
          return open_ply_point_writer(std::move(file), options);
        },
    .header_comes_last = [](const PointWriterOptions& options) { return !options.count; },
};

}  // namespace spillway::formats

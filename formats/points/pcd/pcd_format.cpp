#include "formats/points/pcd/pcd_format.h"

#include <utility>

#include "formats/points/pcd/pcd_header.h"
#include "formats/points/pcd/pcd_reader.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"pcd"};

}  // namespace

constinit const PointFormat kPcdPoints = {
    .name = "pcd",
    .title = "PCD",
    .extensions = kExtensions,
    .recognises = begins_as_pcd,
    .open_reader =
        [](PointInput input, const PointReaderOptions& options) {
          return open_pcd_points(std::move(input.source), input.path, options.skip_invalid);
        },
};

}  // namespace spillway::formats

#include "formats/points/npy/npy_format.h"

#include <utility>

#include "formats/points/npy/npy_header.h"
#include "formats/points/npy/npy_reader.h"
#include "formats/points/npy/npy_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"npy"};

}  // namespace

constinit const PointFormat kNpyPoints = {
    .name = "npy",
    .title = "npy",
    .extensions = kExtensions,
    .holds_attributes = true,
    .recognises = [](std::string_view text) { return text.starts_with(kNpyMagic); },
    .open_reader =
        [](PointInput input, const PointReaderOptions& options) {
          return open_npy_reader(std::move(input.source), input.path, options.skip_invalid);
        },
    .open_writer =
        [](std::unique_ptr<OutputFile> file, const std::string& /*path*/,
           const PointWriterOptions& options) { return open_npy_writer(std::move(file), options); },
    .header_comes_last = [](const PointWriterOptions& options) { return !options.count; },
};

}  // namespace spillway::formats

#include "formats/points/text/text_format.h"

#include <utility>

#include "formats/disk/extension.h"
#include "formats/points/text/text_reader.h"
#include "formats/points/text/text_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"txt", "xyz", "csv", "asc"};

}  // namespace

constinit const PointFormat kTextPoints = {
    .name = "text",
    .title = "text",
    .extensions = kExtensions,
    .is_text = true,
    .holds_attributes = true,
    .open_reader =
        [](PointInput input, const PointReaderOptions& options) {
          return open_text_reader(std::move(input.source), input.path, std::move(input.content),
                                  {options.text, options.skip_invalid});
        },
    .open_writer =
        [](std::unique_ptr<OutputFile> file, const std::string& path,
           const PointWriterOptions& options) {
          return open_text_writer(std::move(file), options,
                                  extension_of(path) == "csv" ? ',' : ' ');
        },
    .writes_attributes =
        [](std::string_view path) { return extension_of(std::string(path)) == "csv"; },
};

}  // namespace spillway::formats

#include "formats/points/create_points.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "formats/bytes/word_list.h"
#include "formats/compression/decompress.h"
#include "formats/disk/extension.h"
#include "formats/disk/spooled_output.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

std::string name_of_output(const std::string& path) {
  return path == "-" ? "standard output" : path;
}

/// The extensions of the formats that are written, the first ones or all.
std::string written_extensions(bool all, std::string_view last, PointFormats formats) {
  std::vector<std::string> extensions;
  for (const PointFormat* const format : formats) {
    if (!is_written(*format)) continue;
    const std::vector<std::string> own = point_extensions({&format, 1});
    extensions.insert(extensions.end(), own.begin(), all ? own.end() : own.begin() + 1);
  }
  return word_list(extensions, last);
}

/// The format by its name, or by the path's; it need not be one that is written.
const PointFormat& chosen_format(const std::string& path, const std::string& format_name,
                                 PointFormats formats) {
  if (!format_name.empty()) return point_format_by_name(format_name, formats);
  if (compression_of_name(path) != Compression::kNone) {
    throw InvalidArgument(
        fmt::format("cannot write {}: compressed points are not written; write them "
                    "to {} and compress that",
                    path, written_extensions(false, "or", formats)),
        {.file = path});
  }
  if (const PointFormat* const format = point_format_of_path(path, formats)) return *format;
  throw InvalidArgument(
      fmt::format("cannot tell the format of {} from its name; end it in {}, or name the format",
                  name_of_output(path), written_extensions(true, "or", formats)),
      {.file = path});
}

}  // namespace

const PointFormat& point_format_to_write(const std::string& path, const std::string& format_name,
                                         PointFormats formats) {
  const PointFormat& format = chosen_format(path, format_name, formats);
  if (is_written(format)) return format;
  throw InvalidArgument(fmt::format("cannot write {}: {} is read, not written; write .laz",
                                    name_of_output(path), format.title),
                        {.file = path});
}

std::unique_ptr<PointWriter> open_point_writer(FileSystem& files, const std::string& path,
                                               const PointWriterOptions& options,
                                               PointFormats formats) {
  const PointFormat& format = point_format_to_write(path, options.format, formats);
  std::unique_ptr<OutputFile> file = files.create(path);
  const bool comes_last = format.header_comes_last != nullptr && format.header_comes_last(options);
  if (comes_last && !file->rewrite(0, {})) {
    if (options.scratch != nullptr) {
      file = spool_output(std::move(file), *options.scratch);
    } else if (!options.count) {
      const auto counts_nothing = [](const PointFormat& other) {
        return is_written(other) && other.header_comes_last == nullptr;
      };
      throw InvalidArgument(
          fmt::format("cannot write {}: its header holds the number of points, which is not known "
                      "beforehand; write {}",
                      file->name(), list_of_points(counts_nothing, "or", formats)),
          {.file = path});
    }
  }
  return format.open_writer(std::move(file), path, options);
}

}  // namespace spillway::formats

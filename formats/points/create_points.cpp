#include "formats/points/create_points.h"

#include <fmt/format.h>

#include <utility>

#include "formats/compression/decompress.h"
#include "formats/disk/extension.h"
#include "formats/disk/spooled_output.h"
#include "formats/points/las/las_writer.h"
#include "formats/points/npy/npy_writer.h"
#include "formats/points/spp/spp_writer.h"
#include "formats/points/text/text_writer.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

/// Whether the header is only right once all points are written.
bool header_comes_last(PointFormat format, const PointWriterOptions& options) {
  if (format == PointFormat::kLas) return !options.count || options.attributes;
  return format == PointFormat::kNpy && !options.count;
}

}  // namespace

PointFormat point_format_to_write(const std::string& path, const std::string& format_name) {
  if (format_name == "laz" || format_name == "copc" ||
      (format_name.empty() && extension_of(path) == "laz")) {
    throw InvalidArgument(fmt::format(
        "cannot write {}: LAZ is read, not written; write .las, or .spp, which is compressed too",
        path == "-" ? "standard output" : path));
  }
  if (!format_name.empty()) return point_format_by_name(format_name);
  if (compression_of_name(path) != Compression::kNone) {
    throw InvalidArgument(
        fmt::format("cannot write {}: compressed points are not written; write them "
                    "to .las, .txt, .npy or .spp and compress that",
                    path));
  }
  const std::optional<PointFormat> format = point_format_of_path(path);
  if (!format) {
    throw InvalidArgument(
        fmt::format("cannot tell the format of {} from its name; end it in .las, "
                    ".txt, .xyz, .csv, .asc, .npy or .spp, or name the format",
                    path == "-" ? "standard output" : path));
  }
  return *format;
}

std::unique_ptr<PointWriter> open_point_writer(FileSystem& files, const std::string& path,
                                               const PointWriterOptions& options) {
  const PointFormat format = point_format_to_write(path, options.format);
  std::unique_ptr<OutputFile> file = files.create(path);
  if (header_comes_last(format, options) && !file->rewrite(0, {})) {
    if (options.scratch != nullptr) {
      file = spool_output(std::move(file), *options.scratch);
    } else if (!options.count) {
      throw InvalidArgument(
          fmt::format("cannot write {}: its header tells the number of points, which is not known "
                      "beforehand; write text or spp",
                      file->name()));
    }
  }
  switch (format) {
    case PointFormat::kLas:
      return open_las_writer(std::move(file), options);
    case PointFormat::kNpy:
      return open_npy_writer(std::move(file), options);
    case PointFormat::kSpp:
      return open_spp_writer(std::move(file), options);
    case PointFormat::kText:
      break;
  }
  return open_text_writer(std::move(file), options, extension_of(path) == "csv" ? ',' : ' ');
}

}  // namespace spillway::detail

#include "formats/point_writer.h"

#include <fmt/format.h>

#include "formats/decompress.h"
#include "formats/las_writer.h"
#include "formats/npy_writer.h"
#include "formats/point_format.h"
#include "formats/spp_writer.h"
#include "formats/text_writer.h"
#include "src/error.h"

namespace spillway {
namespace {

PointFormat format_to_write(const std::string& path, const std::string& format_name) {
  if (!format_name.empty()) return point_format_by_name(format_name);
  if (extension_of(path) == "laz" || compression_of_name(path) != Compression::kNone) {
    throw UsageError(
        fmt::format("cannot write {}: compressed points are not written; write them "
                    "to .las, .txt, .npy or .spp and compress that",
                    path));
  }
  const std::optional<PointFormat> format = point_format_of_path(path);
  if (!format) {
    throw UsageError(
        fmt::format("cannot tell the format of {} from its name; end it in .las, "
                    ".txt, .xyz, .csv, .asc, .npy or .spp, or name the format",
                    path == "-" ? "standard output" : path));
  }
  return *format;
}

}  // namespace

std::unique_ptr<PointWriter> open_point_writer(FileSystem& files, const std::string& path,
                                               const PointWriterOptions& options) {
  const PointFormat format = format_to_write(path, options.format);
  if (!options.count && (format == PointFormat::kLas || format == PointFormat::kNpy)) {
    throw UsageError(
        fmt::format("cannot write {}: its header tells the number of points, which is not known "
                    "beforehand; write text or spp",
                    path));
  }
  std::unique_ptr<OutputFile> file = files.create(path);
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

}  // namespace spillway

#include "formats/points/point_formats.h"

#include <fmt/format.h>

#include <algorithm>

#include "formats/bytes/word_list.h"
#include "formats/compression/decompress.h"
#include "formats/disk/extension.h"
#include "formats/points/copc/copc_format.h"
#include "formats/points/las/las_format.h"
#include "formats/points/laz/laz_format.h"
#include "formats/points/npy/npy_format.h"
#include "formats/points/pcd/pcd_format.h"
#include "formats/points/ply/ply_format.h"
#include "formats/points/raster/raster_format.h"
#include "formats/points/spp/spp_format.h"
#include "formats/points/text/text_format.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

// clang-format off
constexpr const PointFormat* kFormats[] = {
    &kLasPoints,
    &kLazPoints,
    &kCopcPoints,
    &kTextPoints,
    &kNpyPoints,
    &kPlyPoints,
    &kPcdPoints,
    &kSppPoints,
    &kRasterPoints,
};
// clang-format on

const PointFormat* find(PointFormats formats, const auto& is_wanted) {
  const auto found =
      std::ranges::find_if(formats, [&](const PointFormat* f) { return is_wanted(*f); });
  return found == formats.end() ? nullptr : *found;
}

std::vector<std::string> names_of(PointFormats formats, const auto& is_wanted) {
  std::vector<std::string> names;
  for (const PointFormat* const format : formats) {
    if (is_wanted(*format)) names.emplace_back(format->name);
  }
  return names;
}

}  // namespace

PointFormats point_formats() { return kFormats; }

const PointFormat& own_point_stream() { return kSppPoints; }

bool is_written(const PointFormat& format) { return format.open_writer != nullptr; }

std::vector<std::string> point_format_names(PointFormats formats) {
  return names_of(formats, [](const PointFormat&) { return true; });
}

std::vector<std::string> written_point_format_names(PointFormats formats) {
  return names_of(formats, is_written);
}

const PointFormat* find_point_format(std::string_view name, PointFormats formats) {
  return find(formats, [&](const PointFormat& format) { return format.name == name; });
}

const PointFormat& point_format_by_name(std::string_view name, PointFormats formats) {
  if (const PointFormat* const format = find_point_format(name, formats)) return *format;
  throw InvalidArgument(fmt::format("there is no point format \"{}\"; choose {}", name,
                                    word_list(point_format_names(formats), "or")));
}

const PointFormat* point_format_of_bytes(std::string_view first_bytes, PointFormats formats) {
  return find(formats, [&](const PointFormat& format) {
    return format.recognises != nullptr && format.recognises(first_bytes);
  });
}

const PointFormat* point_format_of_header(InputBytes& source, PointFormats formats) {
  return find(formats, [&](const PointFormat& format) {
    return format.has_points != nullptr && format.has_points(source);
  });
}

const PointFormat* point_format_of_path(std::string_view path, PointFormats formats) {
  const std::string extension = extension_of(path);
  const std::string_view stem = path.substr(0, path.size() - extension.size());
  const std::string both = extension_of(stem.substr(0, stem.rfind('.'))) + "." + extension;
  const auto has = [](const PointFormat& format, std::string_view wanted) {
    return std::ranges::find(format.extensions, wanted) != format.extensions.end();
  };
  const PointFormat* const of_both = find(formats, [&](const auto& f) { return has(f, both); });
  if (of_both != nullptr) return of_both;
  const bool compressed = compression_of_name("." + extension) != Compression::kNone;
  return find(formats, [&](const PointFormat& format) {
    return (format.is_text && compressed) || has(format, extension);
  });
}

std::string list_of_points(bool (*chosen)(const PointFormat&), std::string_view last,
                           PointFormats formats) {
  std::vector<std::string> titles;
  for (const PointFormat* const format : formats) {
    if (chosen(*format)) titles.emplace_back(format->title);
  }
  return word_list(titles, last);
}

std::vector<std::string> point_extensions(PointFormats formats) {
  std::vector<std::string> extensions;
  for (const PointFormat* const format : formats) {
    for (const std::string_view extension : format->extensions) {
      extensions.push_back(fmt::format(".{}", extension));
    }
  }
  return extensions;
}

}  // namespace spillway::formats

#include "formats/points/point_format.h"

#include <fmt/format.h>

#include <string>

#include "formats/disk/extension.h"
#include "src/error.h"

namespace spillway::detail {

PointFormat point_format_by_name(std::string_view name) {
  if (name == "las" || name == "laz" || name == "copc") return PointFormat::kLas;
  if (name == "text") return PointFormat::kText;
  if (name == "npy") return PointFormat::kNpy;
  if (name == "spp") return PointFormat::kSpp;
  throw InvalidArgument(fmt::format(
      "there is no point format \"{}\"; choose las, laz, copc, text, npy or spp", name));
}

std::optional<PointFormat> point_format_of_path(std::string_view path) {
  const std::string extension = extension_of(path);
  if (extension == "las" || extension == "laz") return PointFormat::kLas;
  if (extension == "npy") return PointFormat::kNpy;
  if (extension == "spp") return PointFormat::kSpp;
  for (const std::string_view text : {"txt", "xyz", "csv", "asc", "gz", "bz2", "zst", "lz4"}) {
    if (extension == text) return PointFormat::kText;
  }
  return std::nullopt;
}

}  // namespace spillway::detail

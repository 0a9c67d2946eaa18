#include "formats/point_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "src/error.h"

namespace spillway::detail {

PointFormat point_format_by_name(std::string_view name) {
  if (name == "las" || name == "laz" || name == "copc") return PointFormat::kLas;
  if (name == "text") return PointFormat::kText;
  if (name == "npy") return PointFormat::kNpy;
  if (name == "spp") return PointFormat::kSpp;
  throw UsageError(fmt::format(
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

std::string extension_of(std::string_view path) {
  std::string extension = std::filesystem::path(path).extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace spillway::detail

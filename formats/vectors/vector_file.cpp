#include "formats/vectors/vector_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "formats/disk/output_target.h"
#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Journals beside a vector file. Those of an older file of that name would make nonsense of the
/// new one, as would its parts.
constexpr std::array<std::string_view, 3> kJournalEnds = {"-wal", "-shm", "-journal"};

/// The layer's name for a file of that stem. GDAL's GeoPackages take any name, but none that begins
/// with one of these signs.
std::string layer_name(std::string stem) {
  constexpr std::string_view kNotFirst = "`~!@#$%^&*()+-={}|[]\\:\";'<>?,./";
  const std::size_t end = std::min(stem.find_first_not_of(kNotFirst), stem.size());
  std::fill_n(stem.begin(), end, '_');
  return stem;
}

}  // namespace

std::string lost_layers_text(const VectorFormat& format, const std::string& path) {
  constexpr std::size_t kMostNamed = 5;
  if (!format.holds_layers) return "";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return "";
  if (std::filesystem::file_size(path, ignored) == 0) return "";
  const std::filesystem::path target = output_target(path).path;
  std::vector<std::string> lost = gdal().table_names(target.string());
  std::erase(lost, layer_name(target.stem().string()));
  if (lost.empty()) return "";
  const std::size_t named = std::min(lost.size(), kMostNamed);
  return fmt::format(
      "{} is replaced as a whole: its other layer{} {}{} {} lost; name another file to keep {}",
      path, lost.size() == 1 ? "" : "s", fmt::join(lost.begin(), lost.begin() + named, ", "),
      lost.size() > named ? fmt::format(" and {} more", lost.size() - named) : "",
      lost.size() == 1 ? "is" : "are", lost.size() == 1 ? "it" : "them");
}

VectorFile::VectorFile(const VectorFormat& format, VectorLayerOptions options)
    : format_(format), output_(options.path) {
  options.driver = format.driver;
  options.name = output_.name();
  options.layer = layer_name(output_.target().stem().string());
  options.path = output_.path();
  if (!format.takes_backslash && options.path.find('\\') != std::string::npos) {
    throw CannotWrite(options.name,
                      "its path has a backslash, which shapefiles cannot be written to; choose "
                      "another name or folder");
  }
  layer_ = gdal().create_layer(options);
}

void VectorFile::finish() {
  layer_->finish();
  layer_.reset();
  bytes_ = output_.finish(kJournalEnds, format_.part_extensions);
}

}  // namespace spillway::formats

#include "formats/vectors/vector_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway::detail {
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

}  // namespace spillway::detail

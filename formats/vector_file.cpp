#include "formats/vector_file.h"

#include <array>
#include <span>
#include <string_view>

#include "formats/gdal/gdal.h"

namespace spillway {
namespace {

/// What belongs to a vector file beside itself: parts, indices and journals. Those of an older file
/// of that name would make nonsense of the new one.
constexpr std::array<std::string_view, 8> kPartExtensions = {".shx", ".dbf", ".prj", ".cpg",
                                                             ".qix", ".sbn", ".sbx", ".qpj"};
constexpr std::array<std::string_view, 3> kJournalEnds = {"-wal", "-shm", "-journal"};

}  // namespace

VectorFile::VectorFile(VectorLayerOptions options) : output_(options.path) {
  options.name = output_.name();
  options.layer = output_.target().stem().string();
  options.path = output_.path();
  layer_ = gdal().create_layer(options);
}

void VectorFile::finish() {
  layer_->finish();
  layer_.reset();
  const std::span<const std::string_view> parts(kPartExtensions);
  bytes_ =
      output_.finish(kJournalEnds, output_.target().extension() == ".shp" ? parts : parts.first(0));
}

}  // namespace spillway

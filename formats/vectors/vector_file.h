#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "formats/disk/private_output.h"
#include "formats/gdal/vector_layer.h"
#include "formats/vectors/vector_formats.h"

namespace spillway::formats {

/// Says which layers of the file at `path` are lost when a vector file takes its place: all but the
/// one that is written again. Empty if there are none, or nothing is there, or the format holds one
/// layer only.
std::string lost_layers_text(const VectorFormat& format, const std::string& path);

/// A vector file being written. GDAL writes it into a private folder beside the target; finish()
/// gives all its files (a shapefile is five) their names. If destroyed without, or after a signal,
/// nothing is left.
class VectorFile {
 public:
  /// Begins the file `options.path` with a layer that is named after it; name, layer and driver of
  /// the options are set here. Throws Failure if it cannot be created.
  VectorFile(const VectorFormat& format, VectorLayerOptions options);

  [[nodiscard]] VectorLayer& layer() { return *layer_; }

  /// Completes the file. What was there of that name is replaced, with the files that belong to it.
  void finish();

  /// Bytes of all files; 0 before finish().
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  const VectorFormat& format_;
  PrivateOutput output_;
  std::unique_ptr<VectorLayer> layer_;  ///< writes to output_, so it goes first
  std::uint64_t bytes_ = 0;
};

}  // namespace spillway::formats

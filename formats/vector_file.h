#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "formats/gdal/vector_layer.h"

namespace spillway {

/// A vector file (GeoPackage, Shapefile, GeoJSON) being written. GDAL writes it into a private
/// folder beside the target; finish() gives all its files (a shapefile is five) their names. If
/// destroyed without, or after a signal, nothing is left.
class VectorFile {
 public:
  /// Begins the file `options.path` with a layer that is named after it; name and layer of the
  /// options are set here. Throws Error if it cannot be created.
  explicit VectorFile(VectorLayerOptions options);
  ~VectorFile();
  VectorFile(const VectorFile&) = delete;
  VectorFile& operator=(const VectorFile&) = delete;

  [[nodiscard]] VectorLayer& layer() { return *layer_; }

  /// Completes the file. What was there of that name is replaced, with the files that belong to it.
  void finish();

  /// Bytes of all files; 0 before finish().
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  void move_files();

  std::string path_;    // the final one
  std::string folder_;  // the temporary one
  std::unique_ptr<VectorLayer> layer_;
  std::uint64_t bytes_ = 0;
};

}  // namespace spillway

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "formats/file_system.h"
#include "src/geometry/box.h"
#include "src/geometry/lattice.h"
#include "src/geometry/point.h"

namespace spillway {

/// What a point file to be written holds.
struct PointWriterOptions {
  std::string format;   ///< "las", "text", "npy" or "spp"; empty: by extension
  int coordinates = 3;  ///< 2: x and y only (not LAS)
  /// How many points will come; the headers of LAS and npy need it.
  std::optional<std::uint64_t> count;
  std::optional<Lattice> lattice;  ///< set if the points come as integers; LAS requires it
  std::optional<Box<3>> extent;    ///< in output coordinates, where known; told by spp only
  std::string crs;                 ///< as in PointHeader; told by spp only
};

/// Writes points. Nothing appears under the final name before finish().
class PointWriter {
 public:
  virtual ~PointWriter() = default;

  /// Appends points: integers if the options have a lattice, else output coordinates.
  virtual void write(std::span<const Point<3>> points) = 0;

  /// Completes the file. Throws Error if a number of points was promised and another came.
  virtual void finish() = 0;
};

/// Opens `path` ("-": standard output).
std::unique_ptr<PointWriter> open_point_writer(FileSystem& files, const std::string& path,
                                               const PointWriterOptions& options);

}  // namespace spillway

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "formats/file_system.h"
#include "src/geometry/lattice.h"
#include "src/geometry/point.h"

namespace spillway {

/// What a point file to be written holds.
struct PointWriterOptions {
  std::string format;       ///< "las", "text" or "npy"; empty: by extension
  int coordinates = 3;      ///< 2: x and y only (text and npy)
  std::uint64_t count = 0;  ///< how many points will come; the headers of LAS and npy need it
  std::optional<Lattice> lattice;  ///< set if the points come as integers; LAS requires it
};

/// Writes points. Nothing appears under the final name before finish().
class PointWriter {
 public:
  virtual ~PointWriter() = default;

  /// Appends points: integers if the options have a lattice, else output coordinates.
  virtual void write(std::span<const Point<3>> points) = 0;

  /// Completes the file. Throws Error if the number of points is not the promised one.
  virtual void finish() = 0;
};

/// Opens `path` ("-": standard output).
std::unique_ptr<PointWriter> open_point_writer(FileSystem& files, const std::string& path,
                                               const PointWriterOptions& options);

}  // namespace spillway

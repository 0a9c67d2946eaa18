#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/file_system.h"
#include "formats/point_reader.h"
#include "src/geometry/lattice.h"
#include "src/geometry/point.h"
#include "tools/progress.h"

namespace spillway {

/// The points of all inputs, one input after the other, each in its own order.
struct InputPoints {
  /// Integers on `lattice` if that is set, else output coordinates. In two dimensions that concerns
  /// x and y only: z is carried along and always in output coordinates.
  std::vector<Point<3>> points;
  /// Each point's number, counted through all inputs and over withheld points too; if wanted.
  std::vector<std::uint64_t> index;
  /// The first input's lattice, if all inputs lie on it: the same scales, offsets that differ by
  /// whole steps, and one scale for the axes that are triangulated.
  std::optional<Lattice> lattice;
  std::string crs;             ///< of the first input that names one
  std::uint64_t withheld = 0;  ///< points left out because they are flagged so
};

struct InputPointsOptions {
  int dimension = 2;
  bool index = false;  ///< fill InputPoints::index
  PointReaderOptions reader;
};

/// Reads all points of all inputs into memory, as a phase "read". Says what it found to -v.
InputPoints read_input_points(FileSystem& files, const std::vector<std::string>& paths,
                              const InputPointsOptions& options, Progress& progress);

}  // namespace spillway

#pragma once
// From a source to a sink without triangulating.

#include <spillway/context.h>
#include <spillway/export.h>
#include <spillway/mesh.h>
#include <spillway/points.h>
#include <spillway/report.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace spillway {

/// What became of points on their way.
struct PointConversion {
  PointCounts points;
  std::uint64_t written = 0;
  /// The lattice that coordinates were rounded to, and how far one has moved at most.
  bool rounded = false;
  std::array<double, 3> scale{};
  std::array<double, 3> offset{};
  double farthest = 0;
  bool adds_heights = false;        ///< z is 0, since the points have none and the format wants one
  std::vector<std::string> lost{};  ///< what the source has and the format does not hold, in words
  /// Of points that were sorted: cells; points and bytes that were written to scratch files.
  std::uint64_t cells = 0;
  std::uint64_t spilled_points = 0;
  std::uint64_t spilled_bytes = 0;
  std::vector<SkippedFile> skipped_files{};  ///< as Report has them
};

/// Gives all points of the source to the sink, which it begins and finishes. A sink that is a
/// sorted file gets them in its order, for which all are read first, within the context's memory.
/// Throws what source and sink throw, and Error(kInvalidArgument) for a point that the lattice of
/// the output cannot hold.
SPILLWAY_API PointConversion convert(PointSource& source, PointSink& sink, const Context& context);

/// Passes a mesh on, to a file of another format, a raster, contours, a picture, block by block
/// where the source streams. The report has the totals, and what the sink says. Throws what source
/// and sink throw, and Error(kDegenerateInput) for a raster, contours or a picture of no simplex.
SPILLWAY_API Report convert(MeshSource& source, MeshSink& sink, const Context& context);

}  // namespace spillway

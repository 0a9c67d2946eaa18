#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/geometry/lattice.h"
#include "src/geometry/point.h"
#include "stream/checker/checker.h"
#include "stream/library/context/run_watch.h"
#include "stream/points/encoded_points.h"
#include "stream/source/point_stream.h"

namespace spillway::stream {

/// Compares the vertices of a mesh with the distinct points of its input, in bounded memory: both
/// are dealt into tiles, where equal points meet, and each tile is compared for itself.
class PointComparison {
 public:
  /// Keeps about to `memory` bytes. `scratch` must outlive it.
  PointComparison(int dimension, std::uint64_t memory, ScratchFolder& scratch);

  /// Takes the next vertex of the mesh, in output coordinates: x, y and z, and those beyond.
  void add_vertex(const WorldPoint& vertex, std::span<const std::byte> further);

  /// Adds to `report` whether the vertices so far are exactly the distinct points of `input`, both
  /// by their first `dimension` output coordinates, of which the input has those beyond z as
  /// attributes, and no other ones, and, in the plane, whether each vertex's height
  /// lies between those of its points. Reads the input to its end. Its phases are "read points",
  /// of the input; "divide", if need be; and "compare", of vertices and of points that are kept.
  void compare(PointStream& input, const CheckerOptions& options, CheckReport& report,
               RunWatch& watch);

 private:
  void put_away();

  int dimension_;
  std::uint64_t memory_;
  ScratchFolder& scratch_;
  std::uint64_t vertices_ = 0;
  PointBlock pending_;  ///< vertices that are not yet in the file
  std::unique_ptr<ScratchFile> file_;
  std::vector<EncodedBlock> blocks_;
};

}  // namespace spillway::stream

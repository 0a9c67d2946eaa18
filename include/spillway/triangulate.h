#pragma once
// Triangulations of points of any number, through bounded memory.

#include <spillway/context.h>
#include <spillway/error.h>
#include <spillway/export.h>
#include <spillway/mesh.h>
#include <spillway/points.h>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace spillway {

/// Which z a vertex of the plane gets where several points have the same x and y.
enum class Heights { kFirst, kLowest, kHighest, kMean };

/// Which axis a division of points cuts.
enum class Division { kLongestExtent, kCyclingAxis, kConstantAxis };

/// What triangulates the smallest parts. All give the same mesh.
enum class Kernel { kSpillway, kCgal };

/// What is made. Only the first four members change the mesh; the others change the order in which
/// it comes, and how fast.
struct TriangulateOptions {
  int dimension = 2;                  ///< 2: triangles over x, y; 3: tetrahedra
  Heights heights = Heights::kFirst;  ///< dimension 2
  std::optional<double> max_edge{};   ///< leave out simplices with a longer edge
  bool input_index = false;           ///< vertices carry their index in the input
  std::size_t tile_points = 0;        ///< most of a tile; 0: chosen by the memory
  std::size_t leaf_points = 0;        ///< most of a leaf; 0: chosen by number and memory
  Division division = Division::kLongestExtent;
  unsigned children = 2;  ///< parts that are merged at a time, 2 to 1024
  Kernel kernel = Kernel::kSpillway;
};

/// What became of the points of a source.
struct PointCounts {
  std::uint64_t read = 0;      ///< records
  std::uint64_t withheld = 0;  ///< dropped since flagged so
  std::uint64_t skipped = 0;   ///< by PointOptions::every
  std::uint64_t classes = 0;   ///< of other classes
  std::uint64_t returns = 0;   ///< of other returns
  std::uint64_t bounds = 0;    ///< outside of the bounds
  std::uint64_t thinned = 0;   ///< another one stands for their cell
};

/// What a run was like.
struct Report {
  MeshTotals mesh;
  PointCounts points;
  std::uint64_t left_out = 0;  ///< simplices with an edge longer than max_edge
  unsigned threads = 1;        ///< that were used
  std::uint64_t tiles = 0;
  std::uint64_t leaves = 0;
  std::uint64_t spilled_points = 0;  ///< written to scratch files, twice counted twice
  std::uint64_t spilled_bytes = 0;
  std::uint64_t border_bytes = 0;  ///< most of borders that were in memory at a time
  double read_seconds = 0;         ///< wall time
  double triangulate_seconds = 0;  ///< likewise, with all writing but the last
};

/// Triangulates all points of the source and gives the mesh to the sink as it comes: simplices that
/// no other point can change leave memory at once. There is one result for every set of points,
/// whatever the options of the run are (see Delaunay). Throws Error:
///   kInvalidArgument  options that cannot be, a point that is not finite, a memory limit too small
///   kBadInput         a file that is not what it should be, with its name
///   kInputOutput      what the system refuses, with the file and the system's number
///   kOutOfBudget      the border, or scratch files, outgrow their limit
///   kDegenerateInput  no points, or all on one line (in space: in one plane), or no simplex is
///   left
///                     by max_edge
///   kInterrupted      the context's stop token asked for it
///   kClosedPipe       nobody reads the output any more
/// What source and sink throw passes through. Scratch files are gone when it returns or throws.
SPILLWAY_API Report triangulate(PointSource& source, MeshSink& sink,
                                const TriangulateOptions& options, const Context& context);

}  // namespace spillway

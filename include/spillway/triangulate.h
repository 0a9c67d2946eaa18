#pragma once
// Triangulations of points of any number, through bounded memory.

#include <spillway/choices.h>
#include <spillway/context.h>
#include <spillway/error.h>
#include <spillway/export.h>
#include <spillway/mesh.h>
#include <spillway/periodic.h>
#include <spillway/points.h>
#include <spillway/report.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace spillway {

class RunTrace;

/// What is made. Only the first five members change the mesh; the others change the order in which
/// it comes, and how fast.
struct TriangulateOptions {
  int dimension = 2;                  ///< 2: triangles over x, y; 3: tetrahedra; up to 6: simplices
  Heights heights = Heights::kFirst;  ///< dimension 2
  std::optional<double> max_edge{};   ///< leave out simplices with a longer edge
  bool input_index = false;           ///< vertices carry their index in the input
  /// Dimensions 2 and 3: the points repeat with this box, and what is made is the triangulation of
  /// all copies, of which each simplex that differs by more than whole periods comes once
  /// (MeshBlock::offsets). Not with max_edge.
  std::optional<PeriodicBox> periodic{};
  std::size_t tile_points = 0;  ///< most of a tile; 0: chosen by the memory
  std::size_t leaf_points = 0;  ///< most of a leaf; 0: chosen by number and memory
  Division division = Division::kLeastBorder;
  unsigned children = 2;  ///< parts that are merged at a time, 2 to 1024
  /// Whether tiles are triangulated while others are still being read, where headers tell where all
  /// points lie. If a point lies elsewhere then, the run begins again and trusts no header, and the
  /// context is told by a warning; that is an error where inputs cannot be read again (pipes),
  /// and where blocks cannot be taken back (a sink of the program, a mesh
  /// that goes to a pipe).
  bool trust_headers = true;
  Kernel kernel = Kernel::kSpillway;
  /// A folder by which the run can go on if it is killed: the same call goes on from the last
  /// checkpoint there and makes the same mesh, to the last byte. It is made if it is not there, has
  /// the run's scratch files, too, and is removed when the run is complete. Empty: none. Points of
  /// files can be gone on with, those of pipes once all are read, those of a program not. A sink of
  /// a program, and what is made of a mesh, gets its blocks when all of them are known.
  /// Refused with kInvalidArgument if another process uses it, and if its run is of other inputs,
  /// options or another version, with what differs.
  std::string resume_folder{};
  double checkpoint_seconds = 60;  ///< between two checkpoints; longer where they take 2 % of it
  /// For the command, which plays runs again; a program has none.
  std::shared_ptr<RunTrace> trace{};
};

/// Triangulates all points of the source and gives the mesh to the sink as it comes: simplices that
/// no other point can change leave memory at once. There is one result for every set of points,
/// whatever the options of the run are (see Delaunay). Throws Error:
///   kInvalidArgument  options that cannot be, a point that is not finite, a source that was read
///   kBadInput         a file that is not what it should be, with its name
///   kInputOutput      what the system refuses, with the file and the system's number
///   kOutOfBudget      a memory limit too small; the border, or scratch files, outgrow their limit
///   kDegenerateInput  no points, or all on one line (in space: in one plane), or max_edge leaves
///                     no simplex
///   kInterrupted      the context's stop token asked for it
///   kClosedPipe       nobody reads the output any more
/// What source and sink throw passes through. Scratch files are gone when it returns or throws,
/// but those of a resume_folder when it throws.
SPILLWAY_API Report triangulate(PointSource& source, MeshSink& sink,
                                const TriangulateOptions& options, const Context& context);

}  // namespace spillway

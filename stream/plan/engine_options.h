#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "formats/meshes/common/mesh_stream.h"
#include "src/delaunay/base_case/base_case.h"
#include "src/delaunay/division/divide.h"
#include "src/geometry/box.h"
#include "stream/checkpoint/checkpoints.h"
#include "stream/output/heights.h"
#include "stream/plan/run_trace.h"

namespace spillway::detail {

/// How `triangulate_stream` does its work. Of these only max_edge and heights change the mesh; the
/// order of the stream depends on memory and the sizes, never on threads.
struct StreamOptions {
  unsigned threads = 1;
  std::size_t tile_capacity = 0;    ///< points of a tile; 0: chosen by the memory limit
  std::size_t buffered_points = 0;  ///< waiting in memory before any is spilled; 0: likewise
  std::size_t leaf_size = 0;        ///< points of a leaf; 0: chosen by D, n and the memory limit
  Division division = Division::kLeastBorder;
  unsigned children = 2;  ///< parts of a tile that are merged at a time
  Kernel kernel = Kernel::kSpillway;
  /// Points of a border between ranks below which one rank triangulates it; none: chosen by D.
  std::optional<std::size_t> gather_below{};
  Heights heights = Heights::kFirst;
  std::optional<double> max_edge{};  ///< leave out simplices with a longer edge, in output units
  bool input_index = false;
  std::size_t record_size = 0;  ///< bytes of the attributes that points carry
  RunTrace* trace = nullptr;    ///< told what the run does, if there is one
  /// Goes on from its last checkpoint, and makes others, if there is one. Points and blocks go on
  /// (PointStream::goes_on), but for points that have all been read.
  Checkpoints* checkpoints = nullptr;
  /// Triangulate while points are being read, where regions of the source tell where they lie.
  bool early = false;
  /// Told the box around all points in x and y, in the coordinates in which the source gives them,
  /// and how many they are, before the first block is written. Not told in early runs, but see
  /// needs_extent.
  std::function<void(const Box<2>&, std::uint64_t points)> extent_known = [](const Box<2>&,
                                                                             std::uint64_t) {};
  /// Whether blocks may only be written when the extent is known. Early runs take what headers tell
  /// for it then (extent_told), until all is read: if that does not hold, they begin again.
  bool needs_extent = false;
  /// Whether blocks may come on the assumption that the points just fill this box; and later on
  /// whether it makes no difference that they fill this one.
  std::function<bool(const Box<2>&, std::uint64_t points)> extent_told =
      [](const Box<2>&, std::uint64_t) { return false; };
  std::function<bool(const Box<2>&)> extent_holds = [](const Box<2>&) { return false; };
  /// Asked when headers have been found to be false. All blocks so far are void, and so is what
  /// the trace was told. Returns where those go that follow; nullptr if blocks
  /// cannot be taken back.
  std::function<BlockSink*()> begin_again = [] { return nullptr; };
  /// Told why the run begins again.
  std::function<void(std::string_view)> warn = [](std::string_view) {};
  /// Called when a phase begins: "read", "divide" if there are tiles to be divided again,
  /// "triangulate"; and when it has ended, with all points that have been through it.
  std::function<void(const char* phase)> begin_phase = [](const char*) {};
  std::function<void(std::uint64_t points)> end_phase = [](std::uint64_t) {};
  /// Told how many points have been through the phase; called by many threads.
  std::function<void(std::uint64_t points, std::optional<double> fraction)> progress =
      [](std::uint64_t, std::optional<double>) {};
};

}  // namespace spillway::detail

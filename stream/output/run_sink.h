#pragma once

#include <cstdint>
#include <span>

#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/box.h"
#include "src/geometry/framed_point.h"

namespace spillway::stream {

/// Who makes something of the blocks of a run: what it is told of the points besides, and whether
/// it can begin again.
class RunSink {
 public:
  virtual ~RunSink() = default;

  /// Whether extent_known() is needed: a mesh stream has to be read twice then.
  [[nodiscard]] virtual bool wants_extent() const { return false; }

  /// The box around all vertices in x and y, in the coordinates in which they come, and how many
  /// these are (of points: how many points; 0: not known), before the first block. Not told where
  /// extent_told() has accepted another one.
  virtual void extent_known(const Box<2>& /*extent*/, std::uint64_t /*vertices*/) {}

  /// In place of extent_known(), before the first block: what headers tell of the extent. False if
  /// blocks may not come before it is certain.
  virtual bool extent_told(const Box<2>& /*extent*/, std::uint64_t /*vertices*/) { return false; }
  /// After extent_told() and some blocks: whether it makes no difference that this is the extent.
  virtual bool extent_holds(const Box<2>& /*extent*/) { return false; }

  /// Whether simplices are wanted. If not, points may come without any: take_points() alone.
  [[nodiscard]] virtual bool wants_simplices() const { return true; }

  /// Whether take_points() is wanted.
  [[nodiscard]] virtual bool wants_points() const { return false; }
  /// Some of the points, in the coordinates of blocks: each once, those that are one vertex, too.
  /// After the extent is told, by many threads at once and in any order, some of them before and
  /// some after the blocks that they are in.
  virtual void take_points(std::span<const LatticePoint> /*points*/) {}

  /// After some blocks, or none: all of them are void, and the mesh comes once more, after
  /// extent_known() if that is wanted. Returns where blocks go now; nullptr if they cannot be taken
  /// back.
  virtual BlockSink* begin_again() { return nullptr; }
};

}  // namespace spillway::stream

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/meshes/common/corner_offset.h"
#include "src/geometry/framed_point.h"

namespace spillway::formats {

/// Writes one mesh: first all vertices, in blocks of any size, once more while
/// begin_vertices_again(), then all simplices, then finish().
/// Numbers must add up to the header's counts. Nothing appears under the final name before
/// finish(); a writer that is destroyed without it leaves nothing behind.
class MeshWriter {
 public:
  virtual ~MeshWriter() = default;

  /// Appends vertices. `input_index` has one entry a vertex if the header says has_input_index and
  /// is empty otherwise; `attributes` has a record a vertex, as the header has them.
  virtual void write_vertices(std::span<const WorldPoint> vertices,
                              std::span<const std::uint64_t> input_index,
                              std::span<const std::byte> attributes) = 0;

  /// To be called after the last vertex. Returns whether all vertices must be written once more, in
  /// the same order: a format that has what belongs to them in arrays apart need not hold it all.
  virtual bool begin_vertices_again() = 0;

  /// Appends simplices: dimension+1 vertex numbers each, counted from 0, positively oriented.
  virtual void write_simplices(std::span<const std::uint64_t> corners) = 0;

  /// Of a periodic mesh, in a format that holds them: the offsets of corners that have been written,
  /// from that number on, in ascending order. Corners without any have none.
  virtual void write_offsets(std::uint64_t /*first_corner*/,
                             std::span<const CornerOffset> /*offsets*/) {}

  /// Completes the file and gives it its final name. Throws Failure if anything is missing.
  virtual void finish() = 0;
};

}  // namespace spillway::formats

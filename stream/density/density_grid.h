#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/stream_vertices.h"
#include "src/geometry/box.h"

namespace spillway::stream {

/// Where a grid lies, and how it is divided. In the plane it has one cell along z.
struct GridShape {
  std::array<std::uint32_t, 3> cells{1, 1, 1};
  Box<3> box;

  [[nodiscard]] std::size_t count() const { return std::size_t{cells[0]} * cells[1] * cells[2]; }
  [[nodiscard]] double step(int axis) const {
    return (box.hi[axis] - box.lo[axis]) / cells[static_cast<std::size_t>(axis)];
  }
  [[nodiscard]] double centre(int axis, std::int64_t cell) const {
    return box.lo[axis] + (static_cast<double>(cell) + 0.5) * step(axis);
  }
};

/// Interpolates the densities of a mesh of DensityBlocks at the centres of a grid's cells.
class DensityGrid final : public BlockSink {
 public:
  DensityGrid(const MeshStreamHeader& header, const GridShape& shape);

  void write(MeshStreamBlock&& block) override;
  void finish(const MeshTotals& /*totals*/) override {}

  [[nodiscard]] const GridShape& shape() const { return shape_; }
  /// nan where there is no simplex. Shape: cells, x first: z runs fastest.
  [[nodiscard]] const std::vector<double>& values() const { return values_; }

 private:
  struct Corner {
    WorldPoint place;
    double density = 0;
  };

  void paint_copies(const std::array<Corner, 4>& corners);
  void paint(const std::array<Corner, 4>& corners);

  const MeshStreamHeader header_;
  const GridShape shape_;
  std::vector<double> values_;
  StreamVertices<Corner> live_;
};

}  // namespace spillway::stream

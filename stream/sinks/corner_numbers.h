#pragma once
// Numbers that vertices carry, on a grid: of a class, an intensity, a colour.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/points/attributes/attribute_layout.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/lattice.h"
#include "src/geometry/pixel_grid.h"
#include "src/terrain/pixel_centres.h"
#include "src/terrain/triangle_pixels.h"
#include "stream/sinks/raster_store.h"

namespace spillway::stream {

/// A vertex of a terrain with up to three of its numbers.
struct NumberedVertex {
  PlacedPoint place;
  std::array<float, 3> numbers{};
};

/// Puts into each pixel the numbers of the nearest corner of the triangle at its centre: neither
/// the order of triangles nor threads matter. Numbers below 0 are taken for 0.
class CornerNumbers {
 public:
  using Visit = std::function<void(std::uint32_t column, std::uint32_t row,
                                   const std::array<float, 3>& numbers)>;

  /// Of the attributes of these names in `layout`, which has them: one to three. `on_lattice`: the
  /// places of vertices are on it. Takes `memory` bytes, beyond which pixels go to the disk.
  CornerNumbers(const AttributeLayout& layout, std::span<const std::string> names,
                const std::optional<IntegerLattice>& on_lattice, std::optional<double> max_edge,
                std::uint64_t memory, ScratchFolder& scratch);

  /// The numbers in a vertex' record of attributes.
  [[nodiscard]] std::array<float, 3> numbers_in(const std::byte* record) const;
  [[nodiscard]] std::size_t record_size() const { return record_size_; }

  /// Lays the grid; called again, what was painted is forgotten.
  void begin(const PixelGrid& grid);

  /// Paints triangles, three places in `vertices` each. By any number of threads at once.
  void paint(std::span<const NumberedVertex> vertices, std::span<const std::uint32_t> corners);

  /// The largest number of the vertices that have been painted so far.
  [[nodiscard]] float largest() const { return largest_; }

  /// Calls `visit` for each pixel that has numbers, and forgets them.
  void take_all(const Visit& visit);

 private:
  [[nodiscard]] bool is_too_long(const std::array<const NumberedVertex*, 3>& corners) const;
  void paint_triangle(const std::array<const NumberedVertex*, 3>& corners, RasterStore::Hand& hand,
                      std::vector<PixelRun>& runs) const;

  std::vector<AttributeField> fields_;
  std::size_t record_size_;
  const std::optional<IntegerLattice> lattice_;
  const std::optional<double> max_edge_;
  const std::uint64_t memory_;
  ScratchFolder& scratch_;
  PixelGrid grid_;
  std::optional<PixelCentres> centres_;
  std::optional<RasterStore> store_;
  std::atomic<float> largest_ = 0;
};

}  // namespace spillway::stream

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "formats/disk/scratch_folder.h"
#include "src/geometry/box.h"
#include "src/geometry/pixel_grid.h"
#include "src/picture/relief.h"
#include "stream/sinks/corner_numbers.h"
#include "stream/sinks/dem_writer.h"
#include "stream/sinks/scene.h"

namespace spillway::stream {

/// The heights of a terrain on a grid, each the mean of samples of its triangles: of a picture's
/// pixels, of the nodes of a page.
class ReliefSamples {
 public:
  /// Samples may take `memory` bytes while triangles come by `threads` threads. `outline` is told
  /// of triangles as DemSinkOptions has it; or null. `scratch` must outlive it.
  ReliefSamples(const SceneMesh& mesh, PictureColour colour, std::uint64_t memory, unsigned threads,
                ScratchFolder& scratch, std::function<void(const Triangle&)> outline = nullptr);

  /// Where the mesh goes, once the grid is laid.
  BlockSink& writer() { return *writer_; }

  /// What is to be seen, in output coordinates: the zoom, or the box around vertices as they come.
  /// Throws Failure (kDegenerateInput) if all have the same x and y.
  [[nodiscard]] Box<2> seen_box(const PictureOptions& options, const Box<2>& extent) const;

  void begin(const PixelGrid& frame);

  /// When the mesh has gone through. Throws Failure (kDegenerateInput) if there is none.
  HeightPixels collect(const PictureOptions& options);
  /// Likewise: calls `visit` with the numbers of each sample that colours stand for.
  void collect_numbers(const CornerNumbers::Visit& visit);
  /// Of those of all vertices that have come.
  [[nodiscard]] float largest_number() const { return numbers_->largest(); }

  [[nodiscard]] const PixelGrid& frame() const { return frame_; }
  /// Triangles with too long an edge.
  [[nodiscard]] std::uint64_t left_out() const { return dem_.left_out(); }

 private:
  Dem dem_;
  std::optional<CornerNumbers> numbers_;
  std::unique_ptr<BlockSink> writer_;
  PixelGrid frame_;
};

}  // namespace spillway::stream

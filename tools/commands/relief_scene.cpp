#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>

#include "formats/gdal/raster.h"
#include "src/picture/frame.h"
#include "src/picture/line_layer.h"
#include "src/picture/relief.h"
#include "stream/sinks/dem_writer.h"
#include "tools/commands/render_scene.h"
#include "tools/report/usage_error.h"

namespace spillway::detail {
namespace {

constexpr Colour kLineColour = {0.07F, 0.09F, 0.13F};
constexpr float kLineOpacity = 0.6F;

/// Takes the tiles of a DEM as samples of a picture.
class SampleTiles : public Raster {
 public:
  SampleTiles(const PixelGrid& samples, HeightPixels& heights)
      : samples_(samples), heights_(heights) {}

  void write_tile(std::size_t /*band*/, std::uint32_t tile_column, std::uint32_t tile_row,
                  std::span<const float> pixels) override {
    const std::uint32_t first_row = tile_row * kRasterTile;
    const std::uint32_t first_column = tile_column * kRasterTile;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const auto row = static_cast<std::uint32_t>(first_row + i / kRasterTile);
      const auto column = static_cast<std::uint32_t>(first_column + i % kRasterTile);
      if (row < samples_.rows && column < samples_.columns && !std::isnan(pixels[i])) {
        heights_.add(column, row, pixels[i]);
      }
    }
  }
  void finish() override {}

 private:
  const PixelGrid& samples_;
  HeightPixels& heights_;
};

class ReliefScene : public Scene {
 public:
  ReliefScene(const RenderRequest& request, const TerrainHeader& header, std::uint64_t memory,
              unsigned threads, ScratchFolder& scratch)
      : request_(request),
        dem_(dem_options(header, memory, threads), header.lattice, scratch),
        writer_(dem_) {}

  BlockSink& writer() override { return writer_; }

  void extent_known(const Box<2>& extent) override {
    const Box<2> box = request_.zoom.value_or(dem_.in_output(extent));
    if (!(std::max(box.extent(0), box.extent(1)) > 0)) {
      throw Error("all vertices have the same x and y: there is no relief of these");
    }
    frame_ = frame_around(box, request_.size, request_.zoom ? 0 : kMargin);
    PixelGrid samples = frame_;
    samples.resolution /= HeightPixels::kSamples;
    samples.columns *= HeightPixels::kSamples;
    samples.rows *= HeightPixels::kSamples;
    if (request_.wireframe) lines_.emplace(frame_.columns, frame_.rows);
    dem_.begin(samples);
  }

  Picture draw() override {
    HeightPixels heights(frame_.columns, frame_.rows);
    SampleTiles tiles(dem_.grid(), heights);
    dem_.write(tiles, [](std::uint64_t) {});
    if (heights.empty()) {
      throw Error(request_.zoom ? "nothing is seen: --zoom lies beside all triangles"
                                : "nothing is seen: no triangle has an area");
    }
    Relief relief = draw_relief(
        heights, {.pixel_side = frame_.resolution, .exaggeration = request_.exaggeration});
    description_ =
        fmt::format("heights from {:.6g} to {:.6g} in colours, slopes exaggerated {:.3g} x",
                    relief.lowest, relief.highest, relief.exaggeration);
    if (lines_) lines_->cover(relief.picture, kLineColour, kLineOpacity);
    if (hidden_ > seen_) note_hidden_edges("zoom in with --zoom, or give a larger --size");
    return std::move(relief.picture);
  }

  [[nodiscard]] std::string description() const override { return description_; }
  [[nodiscard]] std::uint64_t left_out() const override { return dem_.left_out(); }

 private:
  DemOptions dem_options(const TerrainHeader& header, std::uint64_t memory, unsigned threads) {
    DemOptions options;
    options.products = {DemProduct::kHeight};
    options.max_edge = header.max_edge;
    options.nodata = std::numeric_limits<float>::quiet_NaN();
    options.memory = memory;
    options.threads = threads;
    if (request_.wireframe) options.outline = [this](const Triangle& t) { draw_edges(t); };
    return options;
  }

  void draw_edges(const Triangle& triangle) {
    std::array<Point<2>, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = {(triangle[i][0] - frame_.west) / frame_.resolution,
                    (frame_.north - triangle[i][1]) / frame_.resolution};
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const Point<2>& a = corners[i];
      const Point<2>& b = corners[(i + 1) % 3];
      const float strength = edge_strength(std::hypot(b[0] - a[0], b[1] - a[1]));
      ++(strength > 0 ? seen_ : hidden_);
      lines_->draw(a, b, strength);
    }
  }

  const RenderRequest request_;
  Dem dem_;
  DemWriter writer_;
  PixelGrid frame_;
  std::optional<LineLayer> lines_;
  std::atomic<std::uint64_t> seen_ = 0;  ///< sides of triangles that are long enough
  std::atomic<std::uint64_t> hidden_ = 0;
  std::string description_;
};

}  // namespace

std::unique_ptr<Scene> make_relief_scene(const RenderRequest& request, const TerrainHeader& header,
                                         std::uint64_t memory, unsigned threads,
                                         ScratchFolder& scratch) {
  if (request.slice || request.view) {
    throw UsageError(fmt::format("{} is for tetrahedra (--dim 3), and these are triangles",
                                 request.slice ? "--slice" : "--view"));
  }
  return std::make_unique<ReliefScene>(request, header, memory, threads, scratch);
}

}  // namespace spillway::detail

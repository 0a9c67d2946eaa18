#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>

#include "formats/gdal/raster.h"
#include "src/error.h"
#include "src/picture/frame.h"
#include "src/picture/line_layer.h"
#include "src/picture/relief.h"
#include "stream/sinks/dem_writer.h"
#include "stream/sinks/scene.h"

namespace spillway::stream {
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
  ReliefScene(const PictureOptions& options, const SceneMesh& mesh, std::uint64_t memory,
              unsigned threads, ScratchFolder& scratch)
      : options_(options),
        dem_(dem_options(mesh, memory, threads), mesh.lattice, scratch),
        writer_(dem_) {}

  BlockSink& writer() override { return writer_; }

  void extent_known(const Box<2>& extent) override {
    const Box<2> box = options_.zoom ? plane_box(*options_.zoom) : dem_.in_output(extent);
    if (!(std::max(box.extent(0), box.extent(1)) > 0)) {
      throw Failure("all vertices have the same x and y: there is no relief to draw",
                    ErrorCode::kDegenerateInput);
    }
    frame_ = frame_around(box, options_.size, options_.zoom ? 0 : kMargin);
    PixelGrid samples = frame_;
    samples.resolution /= HeightPixels::kSamples;
    samples.columns *= HeightPixels::kSamples;
    samples.rows *= HeightPixels::kSamples;
    if (options_.wireframe) lines_.emplace(frame_.columns, frame_.rows);
    dem_.begin(samples);
  }

  Picture draw() override {
    HeightPixels heights(frame_.columns, frame_.rows);
    SampleTiles tiles(dem_.grid(), heights);
    dem_.write(tiles, [](std::uint64_t) {});
    if (heights.empty()) {
      throw Failure(options_.zoom ? "nothing is seen: the zoom lies beside all triangles"
                                  : "nothing is seen: no triangle has an area",
                    ErrorCode::kDegenerateInput);
    }
    Relief relief = draw_relief(
        heights, {.pixel_side = frame_.resolution, .exaggeration = options_.exaggeration});
    description_ =
        fmt::format("heights from {:.6g} to {:.6g} in colours, slopes exaggerated {:.3g} x",
                    relief.lowest, relief.highest, relief.exaggeration);
    if (lines_) lines_->cover(relief.picture, kLineColour, kLineOpacity);
    edges_too_small_ = hidden_ > seen_;
    return std::move(relief.picture);
  }

  [[nodiscard]] std::string description() const override { return description_; }
  [[nodiscard]] std::uint64_t left_out() const override { return dem_.left_out(); }

 private:
  DemSinkOptions dem_options(const SceneMesh& mesh, std::uint64_t memory, unsigned threads) {
    DemSinkOptions options;
    options.products = {DemProduct::kHeight};
    options.max_edge = mesh.max_edge;
    options.nodata = std::numeric_limits<float>::quiet_NaN();
    options.memory = memory;
    options.threads = threads;
    if (options_.wireframe) options.outline = [this](const Triangle& t) { draw_edges(t); };
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

  const PictureOptions options_;
  Dem dem_;
  DemWriter writer_;
  PixelGrid frame_;
  std::optional<LineLayer> lines_;
  std::atomic<std::uint64_t> seen_ = 0;  ///< sides of triangles that are long enough
  std::atomic<std::uint64_t> hidden_ = 0;
  std::string description_;
};

}  // namespace

std::unique_ptr<Scene> make_relief_scene(const PictureOptions& options, const SceneMesh& mesh,
                                         std::uint64_t memory, unsigned threads,
                                         ScratchFolder& scratch) {
  if (options.slice || options.view) {
    throw InvalidArgument(fmt::format("a {} is of tetrahedra, and these are triangles",
                                      options.slice ? "slice" : "view"));
  }
  return std::make_unique<ReliefScene>(options, mesh, memory, threads, scratch);
}

}  // namespace spillway::stream

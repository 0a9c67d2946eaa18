#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/error.h"
#include "src/picture/frame.h"
#include "src/picture/height_field.h"
#include "src/picture/line_layer.h"
#include "src/picture/relief.h"
#include "src/picture/tilted.h"
#include "stream/sinks/relief_colours.h"
#include "stream/sinks/relief_samples.h"
#include "stream/sinks/scene.h"

namespace spillway::stream {
namespace {

constexpr Colour kLineColour = {0.07F, 0.09F, 0.13F};
constexpr float kLineOpacity = 0.6F;

class ReliefScene : public Scene {
 public:
  ReliefScene(const PictureOptions& options, const SceneMesh& mesh, std::uint64_t memory,
              unsigned threads, ScratchFolder& scratch)
      : options_(options), samples_(mesh, options.colour, memory, threads, scratch, outline()) {}

  BlockSink& writer() override { return samples_.writer(); }

  void extent_known(const Box<2>& extent) override {
    frame_ = frame_around(samples_.seen_box(options_, extent), picture_size(options_),
                          options_.zoom || options_.view ? 0 : kMargin);
    if (options_.wireframe) lines_.emplace(frame_.columns, frame_.rows);
    samples_.begin(frame_);
  }

  Picture draw() override {
    const HeightPixels heights = samples_.collect(options_);
    const ReliefColours colours(options_, heights, samples_);
    const double exaggeration =
        options_.exaggeration.value_or(visible_exaggeration(heights, frame_.resolution));
    std::optional<HeightField> field;
    if (options_.view || options_.shadows) field.emplace(heights, frame_.resolution, exaggeration);
    const Light light = light_of(options_);
    const std::vector<std::uint8_t> shadows =
        options_.shadows ? cast_shadows(*field, light) : std::vector<std::uint8_t>{};
    Picture map = draw_relief(heights, [&](std::size_t pixel) { return colours.colour(pixel); },
                              {.pixel_side = frame_.resolution,
                               .exaggeration = exaggeration,
                               .light = light,
                               .shadows = shadows});
    description_ = fmt::format("{}, {} exaggerated {:.3g} x", colours.description(),
                               options_.view ? "heights" : "slopes", exaggeration);
    legend_ = colours.legend();
    if (lines_) lines_->cover(map, kLineColour, kLineOpacity);
    edges_too_small_ = hidden_ > seen_;
    if (!options_.view) return map;
    const auto [azimuth, elevation] = *options_.view;
    return draw_tilted(map, *field, {azimuth, elevation, picture_size(options_), kMargin});
  }

  [[nodiscard]] std::string description() const override { return description_; }
  [[nodiscard]] std::optional<Legend> legend() const override { return legend_; }
  [[nodiscard]] std::optional<PixelGrid> place() const override {
    return options_.view ? std::nullopt : std::optional(frame_);
  }
  [[nodiscard]] std::uint64_t left_out() const override { return samples_.left_out(); }

 private:
  std::function<void(const Triangle&)> outline() {
    if (!options_.wireframe) return nullptr;
    return [this](const Triangle& triangle) { draw_edges(triangle); };
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
  ReliefSamples samples_;
  PixelGrid frame_;
  std::optional<LineLayer> lines_;
  std::atomic<std::uint64_t> seen_ = 0;  ///< sides of triangles that are long enough
  std::atomic<std::uint64_t> hidden_ = 0;
  std::string description_;
  std::optional<Legend> legend_;
};

}  // namespace

std::unique_ptr<Scene> make_relief_scene(const PictureOptions& options, const SceneMesh& mesh,
                                         std::uint64_t memory, unsigned threads,
                                         ScratchFolder& scratch) {
  if (options.slice) throw InvalidArgument("a slice is of tetrahedra, and these are triangles");
  return std::make_unique<ReliefScene>(options, mesh, memory, threads, scratch);
}

}  // namespace spillway::stream

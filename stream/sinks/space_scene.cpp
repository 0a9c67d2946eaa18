#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "src/error.h"
#include "src/picture/frame.h"
#include "src/picture/polygons.h"
#include "stream/sinks/scene.h"
#include "stream/sinks/tetrahedron_writers.h"

namespace spillway::stream {
namespace {

constexpr Colour kHullColour = {0.66F, 0.76F, 0.84F};
/// Towards the light of a hull: right, up, towards the viewer.
constexpr Point<3> kLight = {-0.42, 0.64, 0.64};
/// Brightness without that light, and facing it.
constexpr float kAmbient = 0.25F;
constexpr float kFull = 1.15F;

/// Cells of a slice by their size, from small to large.
constexpr std::array<Colour, 5> kSizeColours = {{{0.27F, 0.36F, 0.60F},
                                                 {0.21F, 0.55F, 0.62F},
                                                 {0.36F, 0.71F, 0.55F},
                                                 {0.67F, 0.82F, 0.45F},
                                                 {0.97F, 0.89F, 0.48F}}};

/// Where one looks from: azimuth and elevation in degrees.
constexpr std::array<double, 2> kView = {30, 25};

constexpr float kEdgeOpacity = 0.75F;

double dot(const Point<3>& a, const Point<3>& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Point<3> cross(const Point<3>& a, const Point<3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A picture made of polygons, which are collected first in units of the mesh: x to the right, y
/// upwards.
class PolygonScene : public Scene {
 public:
  explicit PolygonScene(const PictureOptions& options) : options_(options) {}

  void extent_known(const Box<2>& /*extent*/) override {}

  Picture draw() override {
    std::vector<SeenPolygon> polygons = collect();
    const PixelGrid frame = frame_of(polygons);
    for (SeenPolygon& polygon : polygons) {
      for (Point<3>& corner : polygon.corners) {
        corner[0] = (corner[0] - frame.west) / frame.resolution;
        corner[1] = (frame.north - corner[1]) / frame.resolution;
      }
    }
    set_edges(polygons);
    return draw_polygons(polygons, frame.columns, frame.rows);
  }

 protected:
  [[nodiscard]] virtual std::vector<SeenPolygon> collect() = 0;
  /// Decides how strongly edges are drawn, of polygons in pixels.
  virtual void set_edges(std::vector<SeenPolygon>& polygons) = 0;
  [[nodiscard]] const PictureOptions& options() const { return options_; }

 private:
  [[nodiscard]] PixelGrid frame_of(const std::vector<SeenPolygon>& polygons) const {
    if (options_.zoom) return frame_around(plane_box(*options_.zoom), picture_size(options_), 0);
    Box<2> box;
    for (const SeenPolygon& polygon : polygons) {
      for (int i = 0; i < polygon.count; ++i) {
        box.expand(Point<2>{polygon.corners[i][0], polygon.corners[i][1]});
      }
    }
    if (!(std::max(box.extent(0), box.extent(1)) > 0)) {
      throw Failure("nothing is seen: what is to be drawn has no area",
                    ErrorCode::kDegenerateInput);
    }
    return frame_around(box, picture_size(options_), kMargin);
  }

  const PictureOptions options_;
};

class HullScene : public PolygonScene {
 public:
  HullScene(const PictureOptions& options, const SceneMesh& mesh)
      : PolygonScene(options), writer_(mesh.lattice, mesh.max_edge) {
    const auto [from, above] = options.view.value_or(kView);
    const double azimuth = from * std::numbers::pi / 180;
    const double elevation = above * std::numbers::pi / 180;
    towards_ = {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
                std::sin(elevation)};
    right_ = {-std::cos(azimuth), std::sin(azimuth), 0};
    up_ = cross(towards_, right_);
  }

  BlockSink& writer() override { return writer_; }
  [[nodiscard]] std::uint64_t left_out() const override { return writer_.left_out(); }
  [[nodiscard]] std::string description() const override {
    return fmt::format("{} facets of the hull", facets_);
  }

 private:
  [[nodiscard]] std::vector<SeenPolygon> collect() override {
    std::vector<SeenPolygon> polygons;
    for (const std::array<Point<3>, 3>& facet : writer_.facets()) polygons.push_back(seen(facet));
    facets_ = polygons.size();
    return polygons;
  }

  /// All alike: a hull with the edges of its larger facets alone would look spotted.
  void set_edges(std::vector<SeenPolygon>& polygons) override {
    if (!options().wireframe) return;
    std::vector<double> sides;
    for (const SeenPolygon& polygon : polygons) sides.push_back(side_of(polygon));
    const auto middle = sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2);
    std::nth_element(sides.begin(), middle, sides.end());
    const float strength = edge_strength(*middle);
    edges_too_small_ = strength == 0;
    for (SeenPolygon& polygon : polygons) polygon.edge_opacity = kEdgeOpacity * strength;
  }

  [[nodiscard]] SeenPolygon seen(const std::array<Point<3>, 3>& facet) const {
    SeenPolygon polygon;
    for (std::size_t i = 0; i < 3; ++i) {
      polygon.corners[i] = {dot(facet[i], right_), dot(facet[i], up_), dot(facet[i], towards_)};
    }
    std::array<Point<3>, 2> sides{};
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        sides[i][k] = polygon.corners[i + 1][k] - polygon.corners[0][k];
      }
    }
    Point<3> normal = cross(sides[0], sides[1]);
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    // Whatever is seen shows its front.
    const double cosine = dot(normal, kLight) / (normal[2] < 0 ? -length : length);
    // Light reaches round the corner, so that no visible facet is black.
    const double share = length > 0 ? (1 + std::clamp(cosine, -1.0, 1.0)) / 2 : 0;
    polygon.colour =
        mix(kBlack, kHullColour, kAmbient + (kFull - kAmbient) * static_cast<float>(share * share));
    return polygon;
  }

  HullWriter writer_;
  Point<3> towards_{};
  Point<3> right_{};
  Point<3> up_{};
  std::size_t facets_ = 0;
};

class SliceScene : public PolygonScene {
 public:
  SliceScene(const PictureOptions& options, const SceneMesh& mesh)
      : PolygonScene(options), writer_(mesh.lattice, mesh.max_edge, *options.slice) {}

  BlockSink& writer() override { return writer_; }
  [[nodiscard]] std::uint64_t left_out() const override { return writer_.left_out(); }
  [[nodiscard]] std::string description() const override {
    return fmt::format("{} tetrahedra cut", writer_.cuts().size());
  }

 private:
  [[nodiscard]] std::vector<SeenPolygon> collect() override {
    const std::vector<CellCut>& cuts = writer_.cuts();
    if (cuts.empty()) {
      const int axis = options().slice->axis;
      throw Failure(fmt::format("the slice cuts no tetrahedron; their {} is from {} to {}",
                                "xyz"[axis], writer_.extent().lo[axis], writer_.extent().hi[axis]),
                    ErrorCode::kDegenerateInput);
    }
    std::vector<float> sizes;
    for (const CellCut& cell : cuts) sizes.push_back(cell.size);
    std::sort(sizes.begin(), sizes.end());
    const float least = sizes[sizes.size() / 50];
    const float most = sizes[sizes.size() - 1 - sizes.size() / 50];
    std::vector<SeenPolygon> polygons;
    for (const CellCut& cell : cuts) {
      SeenPolygon polygon;
      polygon.count = cell.cut.count;
      for (int i = 0; i < polygon.count; ++i) {
        polygon.corners[i] = {cell.cut.corners[i][0], cell.cut.corners[i][1], 0};
      }
      const float place = most > least ? (cell.size - least) / (most - least) : 0.5F;
      polygon.colour = colour_at(kSizeColours, place);
      polygons.push_back(polygon);
    }
    return polygons;
  }

  /// Each by its size, which ranges widely.
  void set_edges(std::vector<SeenPolygon>& polygons) override {
    for (SeenPolygon& polygon : polygons) {
      polygon.edge_opacity = kEdgeOpacity * edge_strength(side_of(polygon));
    }
  }

  SliceWriter writer_;
};

}  // namespace

std::unique_ptr<Scene> make_space_scene(const PictureOptions& options, const SceneMesh& mesh) {
  if (options.exaggeration) {
    throw InvalidArgument("heights are exaggerated of terrains, and these are tetrahedra");
  }
  if (!options.ramp.empty() || options.colour != PictureColour::kHeight) {
    throw InvalidArgument("colours are chosen of terrains, and these are tetrahedra");
  }
  if (options.light || options.shadows) {
    throw InvalidArgument("light and shadows are chosen of terrains, and these are tetrahedra");
  }
  if (options.legend || options.scale_bar || options.world_file) {
    throw InvalidArgument("a legend, a scale bar and a world file are of terrains");
  }
  if (!options.slice) {
    if (options.zoom) throw InvalidArgument("a zoom is of terrains and slices, and this is a hull");
    return std::make_unique<HullScene>(options, mesh);
  }
  if (options.view) throw InvalidArgument("a view is of the hull: leave it out with a slice");
  if (options.wireframe) {
    throw InvalidArgument(
        "a wireframe is of the hull and of terrains: a slice has edges without it");
  }
  return std::make_unique<SliceScene>(options, mesh);
}

}  // namespace spillway::stream

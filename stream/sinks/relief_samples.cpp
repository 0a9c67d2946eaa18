#include "stream/sinks/relief_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/gdal/raster.h"
#include "src/error.h"

namespace spillway::stream {
namespace {

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

DemSinkOptions dem_options(const SceneMesh& mesh, std::uint64_t memory, unsigned threads,
                           std::function<void(const Triangle&)> outline) {
  DemSinkOptions options;
  options.products = {DemProduct::kHeight};
  options.max_edge = mesh.max_edge;
  options.nodata = std::numeric_limits<float>::quiet_NaN();
  options.memory = memory;
  options.threads = threads;
  options.outline = std::move(outline);
  return options;
}

/// Paints the heights of triangles, and the numbers of their corners.
class NumbersWriter final : public SimplexSink<NumberedVertex> {
 public:
  NumbersWriter(Dem& dem, CornerNumbers& numbers) : SimplexSink(2), dem_(dem), numbers_(numbers) {}

 private:
  [[nodiscard]] std::vector<NumberedVertex> values_of(
      std::span<const LatticePoint> vertices) const override {
    std::vector<NumberedVertex> values(vertices.size());
    const std::vector<PlacedPoint> places = dem_.placed(vertices);
    for (std::size_t v = 0; v < values.size(); ++v) values[v].place = places[v];
    return values;
  }
  [[nodiscard]] std::vector<NumberedVertex> values_with(
      std::span<const LatticePoint> vertices,
      std::span<const std::byte> attributes) const override {
    std::vector<NumberedVertex> values = values_of(vertices);
    for (std::size_t v = 0; v < values.size(); ++v) {
      values[v].numbers = numbers_.numbers_in(&attributes[v * numbers_.record_size()]);
    }
    return values;
  }
  void take_vertices(std::span<const NumberedVertex> /*vertices*/) override {}
  void take_simplices(std::span<const NumberedVertex> vertices,
                      std::span<const std::uint32_t> corners) override {
    std::vector<PlacedPoint> places;
    places.reserve(vertices.size());
    for (const NumberedVertex& vertex : vertices) places.push_back(vertex.place);
    dem_.paint(places, corners);
    numbers_.paint(vertices, corners);
  }

  Dem& dem_;
  CornerNumbers& numbers_;
};

/// The lattice that triangles are painted on, as Dem has it.
std::optional<IntegerLattice> painted_lattice(const std::optional<IntegerLattice>& lattice) {
  const bool is_painted_on = lattice && lattice->scale[0] > 0 && lattice->scale[1] > 0;
  return is_painted_on ? lattice : std::nullopt;
}

}  // namespace

std::vector<std::string> attributes_of(PictureColour colour) {
  switch (colour) {
    case PictureColour::kClass:
      return {"classification"};
    case PictureColour::kIntensity:
      return {"intensity"};
    case PictureColour::kReturn:
      return {"return_number"};
    case PictureColour::kRgb:
      return {"red", "green", "blue"};
    case PictureColour::kHeight:
      break;
  }
  return {};
}

/// Heights and numbers have memory by their bytes.
ReliefSamples::ReliefSamples(const SceneMesh& mesh, PictureColour colour, std::uint64_t memory,
                             unsigned threads, ScratchFolder& scratch,
                             std::function<void(const Triangle&)> outline)
    : dem_(dem_options(mesh, memory / (attributes_of(colour).size() + 1), threads,
                       std::move(outline)),
           mesh.lattice, scratch) {
  const std::vector<std::string> names = attributes_of(colour);
  if (names.empty()) {
    writer_ = std::make_unique<DemWriter>(dem_);
    return;
  }
  numbers_.emplace(mesh.attributes, names, painted_lattice(mesh.lattice), mesh.max_edge,
                   memory / (names.size() + 1) * names.size(), scratch);
  writer_ = std::make_unique<NumbersWriter>(dem_, *numbers_);
}

Box<2> ReliefSamples::seen_box(const PictureOptions& options, const Box<2>& extent) const {
  const Box<2> box = options.zoom ? plane_box(*options.zoom) : dem_.in_output(extent);
  if (!(std::max(box.extent(0), box.extent(1)) > 0)) {
    throw Failure("all vertices have the same x and y: there is no relief to draw",
                  ErrorCode::kDegenerateInput);
  }
  return box;
}

void ReliefSamples::begin(const PixelGrid& frame) {
  frame_ = frame;
  PixelGrid samples = frame;
  samples.resolution /= HeightPixels::kSamples;
  samples.columns *= HeightPixels::kSamples;
  samples.rows *= HeightPixels::kSamples;
  dem_.begin(samples);
  if (numbers_) numbers_->begin(samples);
}

HeightPixels ReliefSamples::collect(const PictureOptions& options) {
  HeightPixels heights(frame_.columns, frame_.rows);
  SampleTiles tiles(dem_.grid(), heights);
  dem_.write(tiles, [](std::uint64_t) {});
  if (heights.empty()) {
    throw Failure(options.zoom
                      ? "nothing is seen: the zoom lies beside all triangles"
                      : "nothing is seen: no triangle has an area, or all are thinner than a pixel",
                  ErrorCode::kDegenerateInput);
  }
  const std::size_t count = std::size_t{heights.columns()} * heights.rows();
  for (std::size_t i = 0; i < count; ++i) {
    if (heights.samples(i) == 0 || std::isfinite(heights.height(i))) continue;
    throw Failure("there are heights beyond 3.4e38, which a picture cannot show",
                  ErrorCode::kDegenerateInput);
  }
  return heights;
}

void ReliefSamples::collect_numbers(const CornerNumbers::Visit& visit) {
  numbers_->take_all(visit);
}

}  // namespace spillway::stream

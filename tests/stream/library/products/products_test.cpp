// Rasters, contours and pictures as sinks of the door: from points, from meshes, by a program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/contours.h>
#include <spillway/convert.h>
#include <spillway/dem.h>
#include <spillway/error.h>
#include <spillway/picture.h>
#include <spillway/triangulate.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/stream/library/error_code.h"

namespace spillway {
namespace {

namespace fs = std::filesystem;

/// A plane that rises by 1 in 2 to the east, with points on a grid of 21 x 11.
std::vector<Point<3>> ramp() {
  std::vector<Point<3>> points;
  for (int x = 0; x <= 20; ++x) {
    for (int y = 0; y <= 10; ++y) points.push_back({x + 0.0, y + 0.0, x / 2.0});
  }
  return points;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Blocks of a mesh that were kept, once more.
class KeptMesh : public MeshSource {
 public:
  [[nodiscard]] MeshHeader header() const override { return header_; }
  bool read(MeshBlock& block) override {
    if (next_ == blocks_.size()) return false;
    block = blocks_[next_++];
    return true;
  }
  [[nodiscard]] MeshTotals totals() override { return totals_; }

  MeshHeader header_;
  std::vector<MeshBlock> blocks_;
  MeshTotals totals_;

 private:
  std::size_t next_ = 0;
};

class Products : public ::testing::Test {
 protected:
  Products() {
    std::string name = ::testing::TempDir() + "spillway-test-products-XXXXXX";
    if (::mkdtemp(name.data()) != nullptr) folder_ = name;
  }
  ~Products() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string file(const std::string& name) const { return folder_ + "/" + name; }

  /// The mesh of the ramp, as a program might have it.
  [[nodiscard]] KeptMesh mesh() const {
    KeptMesh mesh;
    const auto points = ramp();
    const auto source = points_in_memory(points);
    const auto sink = mesh_to([&](const MeshBlock& block) { mesh.blocks_.push_back(block); });
    mesh.totals_ = triangulate(*source, *sink, {}, context_).mesh;
    mesh.header_.points = points.size();
    mesh.header_.extent = Extent{{0, 0, 0}, {20, 10, 10}};
    return mesh;
  }

  /// Writes the same product in three ways, which must give the same bytes: of points, of a mesh
  /// file, by the program's own calls. Returns the report of the first.
  template <typename Sink>
  Report expect_one_file(const std::string& extension,
                         const std::function<std::unique_ptr<Sink>(const std::string&)>& create) {
    const auto points = ramp();
    const auto source = points_in_memory(points);
    const auto of_points = create(file("points." + extension));
    const Report report = triangulate(*source, *of_points, {}, context_);

    KeptMesh kept = mesh();
    const auto spm = create_mesh(file("mesh.spm"), {}, context_);
    EXPECT_EQ(convert(kept, *spm, context_).mesh, report.mesh);
    const auto read = open_mesh(file("mesh.spm"), {}, context_);
    const auto of_file = create(file("file." + extension));
    EXPECT_EQ(convert(*read, *of_file, context_).mesh, report.mesh);

    kept = mesh();
    const auto of_program = create(file("program." + extension));
    of_program->begin(kept.header_);
    for (const MeshBlock& block : kept.blocks_) of_program->write(block);
    of_program->finish(kept.totals_);

    const std::string bytes = bytes_of(file("points." + extension));
    EXPECT_GT(bytes.size(), 100U);
    EXPECT_EQ(bytes.size(), report.output_bytes);
    EXPECT_EQ(bytes_of(file("file." + extension)), bytes);
    EXPECT_EQ(bytes_of(file("program." + extension)), bytes);
    return report;
  }

  std::string folder_;
  const Context context_{{.memory = "128M", .threads = 2}};
};

TEST_F(Products, PixelsInMemoryAreThoseOfAPlaneAndNeedNoFile) {
  const auto points = ramp();
  const auto source = points_in_memory(points);
  DemPixels pixels;
  const auto dem =
      create_dem(pixels, {.resolution = 0.04, .bounds = Extent{{0, 0}, {22, 10}}}, context_);
  const Report report = triangulate(*source, *dem, {}, context_);
  EXPECT_EQ(report.output_bytes, 0U);
  EXPECT_TRUE(fs::is_empty(folder_));
  ASSERT_EQ(dem->report().columns, 550U);
  ASSERT_EQ(dem->report().rows, 250U);
  ASSERT_EQ(pixels.values.size(), 550U * 250U);
  for (std::size_t i = 0; i < pixels.values.size(); ++i) {
    const std::size_t column = i % 550;
    ASSERT_NEAR(pixels.values[i], column < 500 ? (column + 0.5) * 0.02 : -9999, 1e-5) << i;
  }
}

TEST_F(Products, PixelsInMemoryComeBandByBand) {
  const auto points = ramp();
  const auto source = points_in_memory(points);
  DemPixels pixels;
  const auto dem = create_dem(
      pixels, {.products = {DemProduct::kFacetAspect, DemProduct::kHeight}, .resolution = 1},
      context_);
  triangulate(*source, *dem, {}, context_);
  ASSERT_EQ(pixels.values.size(), 2U * 20 * 10);
  EXPECT_EQ(pixels.values.front(), 270);
  EXPECT_EQ(pixels.values[200], 0.25F);
  EXPECT_EQ(pixels.values.back(), 9.75F);
  EXPECT_EQ(pixels.crs, "");
}

TEST_F(Products, APictureIsTheSameOfPointsOfAMeshAndByAProgram) {
  std::unique_ptr<PictureSink> last;
  const Report report = expect_one_file<PictureSink>(
      "png", [&](const std::string& path) { return create_picture(path, {.size = 64}, context_); });
  EXPECT_EQ(report.output_format, "png");
  EXPECT_EQ(report.mesh.simplices, 400U);
}

TEST_F(Products, PicturesOfTetrahedraAreHullsAndSlices) {
  std::vector<Point<3>> points;
  for (int i = 0; i < 4 * 4 * 4; ++i) {
    points.push_back({i % 4 + 0.0, i / 4 % 4 + 0.0, i / 16 + 0.0});
  }
  for (const bool slice : {false, true}) {
    PictureOptions options{.size = 100};
    if (slice) options.slice = Slice{.axis = 2, .value = 1.5};
    const auto picture = create_picture(file("space.png"), options, context_);
    const auto source = points_in_memory(points);
    triangulate(*source, *picture, {.dimension = 3}, context_);
    EXPECT_THAT(picture->report().description,
                ::testing::HasSubstr(slice ? "tetrahedra cut" : "facets of the hull"));
    EXPECT_EQ(picture->report().columns > 0, true);
  }
  const auto source = points_in_memory(points);
  const auto relief = create_picture(file("no.png"), {.exaggeration = 2.0}, context_);
  EXPECT_EQ(code_of([&] { triangulate(*source, *relief, {.dimension = 3}, context_); }),
            ErrorCode::kInvalidArgument);
  EXPECT_FALSE(fs::exists(file("no.png")));
}

TEST_F(Products, WhatCannotBeIsRefusedBeforeAnythingIsRead) {
  EXPECT_EQ(code_of([&] { create_picture(file("a.jpg"), {}, context_); }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { create_picture(file("a.png"), {.size = 3}, context_); }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { create_picture(file("a.png"), {.ramp = "rainbow"}, context_); }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { create_picture(file("a.png"), {.triangles = 5000}, context_); }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { create_picture(file("a.html"), {.size = 500}, context_); }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { create_picture(file("a.html"), {.triangles = 999}, context_); }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { create_picture(file("a.png"), {.size = 20'000}, context_); }),
            ErrorCode::kOutOfBudget)
      << "more pixels than memory";
  EXPECT_EQ(code_of([&] { create_picture(file("none/a.png"), {}, context_); }),
            ErrorCode::kInputOutput);
  EXPECT_EQ(code_of([&] { create_contours(file("a.txt"), {.interval = 1}, context_); }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { create_contours(file("a.gpkg"), {}, context_); }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { create_dem(file("a.png"), {.resolution = 1}, context_); }),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([&] { create_dem(file("a.tif"), {.resolution = 0}, context_); }),
            ErrorCode::kInvalidArgument);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Products, ADemIsTheSameOfPointsOfAMeshAndByAProgram) {
  std::vector<DemReport> reports;
  const Report report = expect_one_file<DemSink>("tif", [&](const std::string& path) {
    return create_dem(
        path, {.products = {DemProduct::kHeight, DemProduct::kSlope}, .resolution = 1}, context_);
  });
  EXPECT_EQ(report.output_format, "tif");
  const auto points = ramp();
  const auto source = points_in_memory(points);
  const auto dem =
      create_dem(file("part.tif"), {.resolution = 0.5, .bounds = Extent{{5, 5}, {8, 7}}}, context_);
  triangulate(*source, *dem, {}, context_);
  EXPECT_EQ(dem->report().columns, 6U);
  EXPECT_EQ(dem->report().rows, 4U);
  EXPECT_EQ(dem->report().pixels_with_data, 24U);
  EXPECT_EQ(dem->report().bands, std::vector<std::string>{"height"});
}

TEST_F(Products, BandsOfPointsHaveNamesAndTheirOwnFaults) {
  using enum DemProduct;
  EXPECT_EQ(dem_band_of("max")->product, kMax);
  EXPECT_EQ(dem_band_of("p99.5")->percentile, 99.5);
  EXPECT_EQ(name_of(*dem_band_of("p050")), "p50");
  EXPECT_EQ(name_of({kStddev}), "stddev");
  for (const char* const none : {"p", "p-1", "p101", "pnan", "p5 ", "percentile", "Max", ""}) {
    EXPECT_FALSE(dem_band_of(none)) << none;
  }
  const DemOptions one{.products = {kPercentile}, .resolution = 1, .percentiles = {50}};
  std::vector<DemOptions> wrong(6, one);
  wrong[0].percentiles = {};
  wrong[1].percentiles = {50, 60};
  wrong[2].percentiles = {100.5};
  wrong[3].products = {kPercentile, kPercentile};
  wrong[3].percentiles = {50, 50};
  wrong[4].products = {kMax, kMax};
  wrong[5] = {.products = {kCount, kHeight}, .resolution = 1, .fill_voids = true};
  for (const DemOptions& options : wrong) {
    EXPECT_EQ(code_of([&] { create_dem(file("a.tif"), options, context_); }),
              ErrorCode::kInvalidArgument);
  }
}

TEST_F(Products, RastersOfPointsNeedPointsAndNoTriangles) {
  const DemOptions how{.products = {DemProduct::kMax, DemProduct::kCount}, .resolution = 1};
  const auto line = points_in_memory(std::vector<Point<3>>{{0, 0, 1}, {1, 1, 2}, {0, 0, 4}});
  DemPixels pixels;
  const auto dem = create_dem(pixels, how, context_);
  const Report report = triangulate(*line, *dem, {}, context_);
  EXPECT_EQ(report.mesh.points, 3U);
  EXPECT_EQ(report.mesh.simplices, 0U);
  EXPECT_THAT(pixels.values, ::testing::ElementsAre(4, 3)) << "of one pixel";
  EXPECT_EQ(dem->report().points_in_pixels, 3U);
  EXPECT_EQ(dem->report().pixels_with_points, 1U);
  const auto of_nothing = create_dem(pixels, how, context_);
  const auto nothing = points_in_memory(std::vector<Point<3>>{});
  EXPECT_EQ(code_of([&] { triangulate(*nothing, *of_nothing, {}, context_); }),
            ErrorCode::kDegenerateInput);
  const auto resumed = create_dem(pixels, how, context_);
  const auto again = points_in_memory(std::vector<Point<3>>{{0, 0, 1}});
  EXPECT_EQ(
      code_of([&] { triangulate(*again, *resumed, {.resume_folder = file("run")}, context_); }),
      ErrorCode::kInvalidArgument);
  const auto of_mesh = create_dem(pixels, how, context_);
  EXPECT_EQ(code_of([&] {
              of_mesh->begin({.extent = Extent{{0, 0, 0}, {1, 1, 1}}});
            }),
            ErrorCode::kInvalidArgument);
}

TEST_F(Products, ContoursTellTheirLinesAndTheHeights) {
  const auto points = ramp();
  const auto source = points_in_memory(points);
  const auto contours = create_contours(file("lines.gpkg"), {.interval = 2.5}, context_);
  const Report report = triangulate(*source, *contours, {}, context_);
  EXPECT_EQ(contours->report().lines, 4U) << "at 2.5, 5, 7.5 and, along the edge, 10";
  EXPECT_EQ(contours->report().lowest, 0);
  EXPECT_EQ(contours->report().highest, 10);
  EXPECT_EQ(report.output_bytes, fs::file_size(file("lines.gpkg")));
}

TEST_F(Products, ContoursAsGeoJsonTakeAWordAboutCoordinates) {
  const auto points = ramp();
  ContourOptions how{.interval = 2.5};
  const auto refused = create_contours(file("lines.geojson"), how, context_);
  const auto source = points_in_memory(points);
  EXPECT_EQ(code_of([&] { triangulate(*source, *refused, {}, context_); }), ErrorCode::kBadInput);
  how.foreign_crs = true;
  const auto agreed = create_contours(file("lines.geojson"), how, context_);
  const auto again = points_in_memory(points);
  triangulate(*again, *agreed, {}, context_);
  EXPECT_EQ(agreed->report().lines, 4U);
}

TEST_F(Products, AFileHasTheSystemThatIsGivenForIt) {
  std::ofstream(file("points.txt")) << "0 0 1\n9 0 2\n0 9 3\n";
  PointOptions how;
  how.crs = "EPSG:25832";
  EXPECT_EQ(open_points({file("points.txt")}, how, context_)->header().crs, "EPSG:25832");
  how.crs = "nonsense";
  EXPECT_EQ(code_of([&] { open_points({file("points.txt")}, how, context_); }),
            ErrorCode::kInvalidArgument);
}

TEST_F(Products, ATerrainHasHeightsAndTriangles) {
  const std::vector<Point<2>> flat{{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  for (const int fault : {0, 1}) {
    const auto dem = create_dem(file("no.tif"), {.resolution = 0.1}, context_);
    const auto contours = create_contours(file("no.gpkg"), {.interval = 1}, context_);
    for (MeshSink* const sink :
         {static_cast<MeshSink*>(dem.get()), static_cast<MeshSink*>(contours.get())}) {
      const auto points = ramp();
      const auto source = fault == 0 ? points_in_memory(flat) : points_in_memory(points);
      EXPECT_EQ(code_of([&] { triangulate(*source, *sink, {.dimension = fault + 2}, context_); }),
                ErrorCode::kDegenerateInput);
    }
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace spillway

// Densities of points, through the door for programs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/convert.h>
#include <spillway/density.h>
#include <spillway/generate.h>
#include <spillway/triangulate.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "src/error.h"

namespace spillway {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::vector<Point<3>> random_points(std::size_t count, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<Point<3>> points(count);
  for (auto& point : points) point = {coordinate(random), coordinate(random), coordinate(random)};
  return points;
}

constexpr PeriodicBox kUnitBox{.box = {{0, 0, 0}, {1, 1, 1}}};

class Densities : public ::testing::TestWithParam<int> {
 protected:
  Densities() {
    std::string name = ::testing::TempDir() + "spillway-test-density-XXXXXX";
    if (::mkdtemp(name.data()) != nullptr) folder_ = name;
  }
  ~Densities() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ + "/" + name; }
  [[nodiscard]] Context context() const {
    ContextOptions options;
    options.memory = 256 << 20;
    options.threads = 2;
    options.scratch_folder = folder_;
    return Context(options);
  }

  DensityTotals made(const std::vector<Point<3>>& points, const std::string& name,
                     const DensityOptions& options = {},
                     const std::optional<PeriodicBox>& periodic = {}, TriangulateOptions how = {}) {
    const Context context = this->context();
    const auto sink = create_density(path(name), options, context);
    how.dimension = GetParam();
    how.periodic = periodic;
    triangulate(*points_in_memory(PointView<3>(points), {}), *sink, how, context);
    return sink->totals();
  }

  /// The doubles behind the header of an npy file.
  [[nodiscard]] std::vector<double> numbers(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    std::size_t begin = 0;
    while (begin < bytes.size() && bytes[begin] != '\n') ++begin;
    ++begin;
    std::vector<double> numbers((bytes.size() - begin) / sizeof(double));
    std::memcpy(numbers.data(), bytes.data() + begin, numbers.size() * sizeof(double));
    return numbers;
  }

  [[nodiscard]] std::array<std::uint32_t, 3> cells(std::uint32_t side) const {
    return {side, side, GetParam() == 3 ? side : 0};
  }

  std::string folder_;
};

TEST_P(Densities, MassesOfAPeriodicSetSumToTheNumberOfPoints) {
  const DensityTotals totals = made(random_points(5000), "density.npy", {}, kUnitBox);
  EXPECT_NEAR(totals.mass, 5000, 1e-8);
  EXPECT_NEAR(totals.volume, 1, 1e-12);
  EXPECT_LT(totals.least, 5000);
  EXPECT_GT(totals.most, 5000);
}

TEST_P(Densities, MassesOfAnOpenSetDoToo) {
  const DensityTotals totals = made(random_points(5000), "density.npy");
  EXPECT_NEAR(totals.mass, 5000, 1e-8);
  EXPECT_LT(totals.volume, 1);
}

TEST_P(Densities, ALatticeIsAsDenseEverywhere) {
  std::vector<Point<3>> points;
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      for (int z = 0; z < (GetParam() == 3 ? 8 : 1); ++z)
        points.push_back({x * 1., y * 1., z * 1.});
    }
  }
  const PeriodicBox box{.box = {{0, 0, 0}, {8, 8, 8}}};
  const DensityTotals totals = made(points, "density.npy", {}, box);
  EXPECT_NEAR(totals.least, 1, 1e-12);
  EXPECT_NEAR(totals.most, 1, 1e-12);
}

TEST_P(Densities, AtVerticesAreThoseOfTheSimplicesAround) {
  const std::vector<Point<3>> points = random_points(800);
  const Context context = this->context();
  made(points, "density.spm", {}, kUnitBox);
  MeshInMemory mesh({"density"});
  convert(*open_mesh(path("density.spm"), {}, context), mesh, context);
  const auto axes = static_cast<std::size_t>(GetParam());
  std::vector<double> volumes(mesh.vertices().size());
  for (std::size_t c = 0; c < mesh.corners().size(); c += axes + 1) {
    std::array<std::array<double, 3>, 4> at{};
    for (std::size_t i = 0; i <= axes; ++i) {
      for (std::size_t k = 0; k < axes; ++k) {
        at[i][k] = mesh.vertices()[mesh.corners()[c + i]][k] + mesh.offsets()[(c + i) * axes + k];
      }
    }
    std::array<std::array<double, 3>, 3> e{};
    for (std::size_t i = 0; i < axes; ++i) {
      for (std::size_t k = 0; k < axes; ++k) e[i][k] = at[i + 1][k] - at[0][k];
    }
    if (axes == 2) e[2] = {0, 0, 3};
    const double volume = std::abs(e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                                   e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                                   e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
                          6;
    for (std::size_t i = 0; i <= axes; ++i) volumes[mesh.corners()[c + i]] += volume;
  }
  const auto density = mesh.attributes().values<double>("density");
  ASSERT_EQ(density.size(), points.size());
  for (std::size_t v = 0; v < density.size(); ++v) {
    EXPECT_NEAR(density[v] * volumes[v], static_cast<double>(axes + 1), 1e-9);
  }
}

TEST_P(Densities, DoNotDependOnHowTheWorkIsDivided) {
  const std::vector<Point<3>> points = random_points(20'000);
  for (const std::optional<PeriodicBox>& box :
       {std::optional<PeriodicBox>{}, std::optional<PeriodicBox>{kUnitBox}}) {
    const DensityTotals all = made(points, "all.npy", {.cells = cells(20)}, box);
    const DensityTotals parts = made(points, "parts.npy", {.cells = cells(20)}, box,
                                     {.tile_points = 3000, .leaf_points = 200});
    EXPECT_NEAR(parts.mass, all.mass, 1e-8);
    EXPECT_DOUBLE_EQ(parts.most, all.most);
    const std::vector<double> one = numbers("all.npy");
    const std::vector<double> other = numbers("parts.npy");
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      if (std::isnan(one[i])) {
        EXPECT_TRUE(std::isnan(other[i]));
      } else {
        EXPECT_NEAR(one[i], other[i], 1e-6 * std::abs(one[i]) + 1e-6);
      }
    }
  }
}

TEST_P(Densities, WeightsAreAColumnOfThePoints) {
  const std::vector<Point<3>> points = random_points(2000);
  AttributeColumns columns({Attribute{.name = "mass", .type = NumberType::kFloat32}});
  columns.resize(points.size());
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    columns.values<float>("mass")[i] = static_cast<float>(i % 7) * 0.5F;
    sum += static_cast<double>(i % 7) * 0.5;
  }
  const Context context = this->context();
  const auto sink = create_density(path("density.vtu"), {.weight = "mass"}, context);
  triangulate(*points_in_memory(PointView<3>(points), columns), *sink,
              {.dimension = GetParam(), .periodic = kUnitBox}, context);
  EXPECT_NEAR(sink->totals().mass, sum, 1e-8);
  const auto unknown = create_density(path("density.vtu"), {.weight = "weight"}, context);
  try {
    triangulate(*points_in_memory(PointView<3>(points), columns), *unknown,
                {.dimension = GetParam()}, context);
    FAIL() << "an unknown weight was taken";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("weight"));
  }
}

TEST_P(Densities, AGridInAPeriodicBoxHasNoGapsAndTheMassOfThePoints) {
  made(random_points(GetParam() == 2 ? 3000 : 1000), "grid.npy", {.cells = cells(60)}, kUnitBox);
  const std::vector<double> grid = numbers("grid.npy");
  ASSERT_EQ(grid.size(), GetParam() == 2 ? 3600U : 216000U);
  double sum = 0;
  for (const double value : grid) {
    ASSERT_FALSE(std::isnan(value));
    sum += value;
  }
  // Between centres the density is not linear, so that the sum is near the mass only.
  const double mass = GetParam() == 2 ? 3000 : 1000;
  EXPECT_NEAR(sum / static_cast<double>(grid.size()), mass, 0.1 * mass);
}

TEST_P(Densities, AGridBesideThePeriodicBoxHasThatOfTheCopies) {
  const std::vector<Point<3>> points = random_points(800);
  made(points, "box.npy", {.cells = cells(20)}, kUnitBox);
  const std::vector<double> box = numbers("box.npy");
  for (const double moved : {1.0, -3.0}) {
    made(points, "moved.npy",
         {.cells = cells(20),
          .grid_box = Extent{{moved, moved, moved}, {moved + 1, moved + 1, moved + 1}}},
         kUnitBox);
    const std::vector<double> copies = numbers("moved.npy");
    ASSERT_EQ(copies.size(), box.size());
    for (std::size_t i = 0; i < box.size(); ++i) EXPECT_NEAR(copies[i], box[i], 1e-6 * box[i]);
  }
  made(points, "large.npy", {.cells = cells(12), .grid_box = Extent{{-1, -1, -1}, {2, 2, 2}}},
       kUnitBox);
  made(points, "small.npy",
       {.cells = cells(9), .grid_box = Extent{{0.1, 0.1, 0.1}, {0.7, 0.7, 0.7}}}, kUnitBox);
  for (const char* const name : {"large.npy", "small.npy"}) {
    for (const double value : numbers(name)) EXPECT_FALSE(std::isnan(value));
  }
}

TEST_P(Densities, AnOpenGridHasNanOutsideOfTheHull) {
  made(random_points(500), "grid.npy",
       {.cells = cells(10), .grid_box = Extent{{-1, -1, -1}, {2, 2, 2}}});
  const std::vector<double> grid = numbers("grid.npy");
  EXPECT_TRUE(std::isnan(grid.front()));
  std::size_t inside = 0;
  for (const double value : grid) inside += std::isnan(value) ? 0 : 1;
  EXPECT_GT(inside, 0U);
  EXPECT_LT(inside, grid.size());
}

TEST_P(Densities, WhatCannotBeIsRefused) {
  const Context context = this->context();
  const auto refusal = [&](const std::string& name, const DensityOptions& options) {
    try {
      made(random_points(100), name, options);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
      EXPECT_FALSE(fs::exists(path(name)));
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_THAT(refusal("density.txt", {}), HasSubstr("npy or a mesh"));
  EXPECT_THAT(refusal("density.vtu", {.cells = {5, 5, 5}}), HasSubstr("npy or GeoTIFF"));
  EXPECT_THAT(refusal("density.npy", {.cells = {5, 0, 0}}), HasSubstr("no cells along y"));
  EXPECT_THAT(refusal("density.npy", {.grid_box = Extent{}}), HasSubstr("no effect"));
  EXPECT_THAT(refusal("density.obj", {}), HasSubstr("density"));
  EXPECT_THAT(refusal("density.npy", {.cells = {1000000, 1000000, 1000000}}),
              HasSubstr("choose fewer cells"));
  EXPECT_THAT(
      refusal("density.npy", {.cells = {5, 5, 5}, .grid_box = Extent{{0, 0, 0}, {1, 0, 1}}}),
      HasSubstr("no length along y"));
  if (GetParam() == 3) {
    EXPECT_THAT(refusal("density.tif", {.cells = {5, 5, 5}}), HasSubstr("rasters of the plane"));
  }
}

TEST_P(Densities, HaloesAreDenserThanWhatLiesBetween) {
  const Context context = this->context();
  const auto points =
      generate_points({.family = "haloes", .count = 20'000, .dimension = GetParam(), .seed = 3});
  const auto sink = create_density(path("haloes.vtu"), {}, context);
  triangulate(*points, *sink, {.dimension = GetParam(), .periodic = kUnitBox}, context);
  EXPECT_NEAR(sink->totals().mass, 20'000, 1e-6);
  EXPECT_GT(sink->totals().most, 1000 * sink->totals().least);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Densities, ::testing::Values(2, 3), [](const auto& dimension) {
  return std::to_string(dimension.param) + "D";
});

}  // namespace
}  // namespace spillway

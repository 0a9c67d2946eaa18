// Meshes that are cut into a file for each tile: of whole simplices, each once.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/check.h>
#include <spillway/convert.h>
#include <spillway/triangulate.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "tests/stream/library/call_test.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Its corners, sorted.
using Simplex = std::vector<Point<3>>;

std::vector<Point<3>> random_points(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-500, 500);
  std::vector<Point<3>> points;
  while (points.size() < count) points.push_back({place(random), place(random), place(random)});
  return points;
}

/// Of a grid every four neighbours lie on a circle, and many centroids on the edges of tiles.
std::vector<Point<3>> grid_points(int side) {
  std::vector<Point<3>> points;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      points.push_back({static_cast<double>(i), static_cast<double>(j), std::sin(i * j)});
    }
  }
  return points;
}

std::vector<Simplex> simplices_of(const MeshInMemory& mesh) {
  std::vector<Simplex> simplices;
  const auto corners = static_cast<std::size_t>(mesh.header().dimension + 1);
  for (std::size_t c = 0; c < mesh.corners().size(); c += corners) {
    Simplex& simplex = simplices.emplace_back();
    for (std::size_t i = 0; i < corners; ++i) {
      simplex.push_back(mesh.vertices()[mesh.corners()[c + i]]);
    }
    std::ranges::sort(simplex);
  }
  std::ranges::sort(simplices);
  return simplices;
}

class MeshTiles : public CallTest {
 protected:
  static Report send(const std::vector<Point<3>>& points, MeshSink& sink, const Context& context,
                     const TriangulateOptions& how = {}) {
    const auto source = points_in_memory(PointView<3>(points));
    return triangulate(*source, sink, how, context);
  }

  static MeshInMemory& read(const std::string& path, MeshInMemory& mesh, const Context& context) {
    convert(*open_mesh(path, {}, context), mesh, context);
    return mesh;
  }

  /// By name, those whose name has `ending`.
  [[nodiscard]] std::map<std::string, std::string> files(const std::string& ending) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(file(""))) {
      const std::string name = entry.path().filename();
      if (name.ends_with(ending)) files[name] = entry.path();
    }
    return files;
  }

  void expect_parts_of_whole(const std::vector<Point<3>>& points, const TriangulateOptions& how,
                             double side, const std::string& extension) {
    const Context context(options());
    MeshInMemory whole;
    send(points, whole, context, how);
    MeshFileOptions tiled;
    tiled.tile_side = side;
    const Report report =
        send(points, *create_mesh(file("t_{x}_{y}" + extension), tiled, context), context, how);
    std::vector<Simplex> together;
    const auto tiles = files(extension);
    EXPECT_EQ(report.output_files, tiles.size());
    EXPECT_EQ(report.outside_tiles, 0U);
    std::uint64_t bytes = 0;
    for (const auto& [name, path] : tiles) {
      bytes += std::filesystem::file_size(path);
      MeshInMemory tile;
      for (const Simplex& simplex : simplices_of(read(path, tile, context))) {
        together.push_back(simplex);
        double x = 0;
        double y = 0;
        for (const Point<3>& corner : simplex) {
          x += corner[0] / static_cast<double>(simplex.size());
          y += corner[1] / static_cast<double>(simplex.size());
        }
        double west = 0;
        double south = 0;
        ASSERT_EQ(std::sscanf(name.c_str(), "t_%lf_%lf", &west, &south), 2) << name;
        EXPECT_TRUE(x > west - 1e-9 && x < west + side + 1e-9) << name;
        EXPECT_TRUE(y > south - 1e-9 && y < south + side + 1e-9) << name;
      }
      std::set<std::uint64_t> used(tile.corners().begin(), tile.corners().end());
      EXPECT_EQ(used.size(), tile.vertices().size()) << name;
      std::set<Point<3>> places(tile.vertices().begin(), tile.vertices().end());
      EXPECT_EQ(places.size(), tile.vertices().size()) << name;
    }
    EXPECT_EQ(report.output_bytes, bytes);
    std::ranges::sort(together);
    EXPECT_EQ(together, simplices_of(whole));
  }
};

TEST_F(MeshTiles, TogetherAreTheWholeMesh) {
  expect_parts_of_whole(random_points(20000, 1), {}, 170, ".spm");
}

TEST_F(MeshTiles, OfPointsOnAGridHaveEachTriangleOnce) {
  expect_parts_of_whole(grid_points(60), {}, 7, ".ply");
}

TEST_F(MeshTiles, OfTetrahedraStandSideBySideInXAndY) {
  expect_parts_of_whole(random_points(3000, 2), {.dimension = 3}, 250, ".vtu");
}

TEST_F(MeshTiles, AreTheSameForAnyThreadsAndMemory) {
  const std::vector<Point<3>> points = random_points(150000, 3);
  MeshFileOptions tiled;
  tiled.tile_side = 100;
  std::vector<std::map<std::string, std::vector<Simplex>>> runs;
  for (const auto& [threads, memory, tile_points] :
       {std::tuple(1U, "1G", std::size_t{0}), std::tuple(2U, "64M", std::size_t{10000})}) {
    ContextOptions limits = options();
    limits.threads = threads;
    limits.memory = memory;
    const Context context(limits);
    const std::string pattern = fmt::format("{}_{{x}}_{{y}}.spm", threads);
    send(points, *create_mesh(file(pattern), tiled, context), context,
         {.tile_points = tile_points});
    auto& tiles = runs.emplace_back();
    for (const auto& [name, path] : files(".spm")) {
      MeshInMemory mesh;
      if (name.starts_with(fmt::format("{}_", threads))) {
        tiles[name.substr(2)] = simplices_of(read(path, mesh, context));
      }
    }
  }
  EXPECT_EQ(runs[0].size(), 100U);
  EXPECT_EQ(runs[0], runs[1]);
}

TEST_F(MeshTiles, EndWithTheirOwnTotals) {
  const Context context(options());
  MeshFileOptions tiled;
  tiled.tile_side = 500;
  send(random_points(5000, 4), *create_mesh(file("{x}_{y}.spm"), tiled, context), context);
  for (const auto& [name, path] : files(".spm")) {
    MeshInMemory mesh;
    read(path, mesh, context);
    const auto checked = check(*open_mesh(path, {}, context), {}, context);
    EXPECT_EQ(mesh.totals().canonical_hash, checked.canonical_hash) << name;
    EXPECT_EQ(mesh.totals().hull_facets, checked.hull_facets) << name;
    EXPECT_EQ(mesh.totals().simplices, mesh.corners().size() / 3) << name;
    EXPECT_EQ(mesh.totals().vertices, mesh.vertices().size()) << name;
  }
}

TEST_F(MeshTiles, KeepTheIndexInTheInput) {
  const std::vector<Point<3>> points = random_points(4000, 5);
  const Context context(options());
  MeshFileOptions tiled;
  tiled.tile_side = 300;
  send(points, *create_mesh(file("{x}_{y}.spm"), tiled, context), context, {.input_index = true});
  for (const auto& [name, path] : files(".spm")) {
    MeshInMemory mesh;
    read(path, mesh, context);
    ASSERT_EQ(mesh.input_index().size(), mesh.vertices().size()) << name;
    for (std::size_t v = 0; v < mesh.vertices().size(); ++v) {
      ASSERT_EQ(points[mesh.input_index()[v]], mesh.vertices()[v]) << name;
    }
  }
}

TEST_F(MeshTiles, AreMadeOfAMeshThatIsConvertedToo) {
  const std::vector<Point<3>> points = random_points(20000, 6);
  const Context context(options());
  send(points, *create_mesh(file("whole.ply"), {}, context), context);
  MeshFileOptions tiled;
  tiled.tile_side = 200;
  send(points, *create_mesh(file("a_{x}_{y}.off"), tiled, context), context);
  convert(*open_mesh(file("whole.ply"), {}, context),
          *create_mesh(file("b_{x}_{y}.off"), tiled, context), context);
  const auto tiles = files(".off");
  EXPECT_EQ(tiles.size(), 2U * 36);
  for (const auto& [name, path] : tiles) {
    if (name[0] != 'a') continue;
    MeshInMemory a;
    MeshInMemory b;
    EXPECT_EQ(simplices_of(read(path, a, context)),
              simplices_of(read(file("b" + name.substr(1)), b, context)))
        << name;
  }
}

TEST_F(MeshTiles, TellOfFilesThatAnotherRunLeft) {
  const Context context(options());
  std::ofstream(file("t_7000_7000.obj")) << "";
  MeshFileOptions tiled;
  tiled.tile_side = 1000;
  const Report report =
      send(random_points(100, 7), *create_mesh(file("t_{x}_{y}.obj"), tiled, context), context);
  EXPECT_EQ(report.output_files, 4U);
  EXPECT_EQ(report.other_files, std::vector<std::string>{file("t_7000_7000.obj")});
}

TEST_F(MeshTiles, TellOfVerticesWithoutASimplex) {
  const Context context(options());
  MeshFileOptions tiled;
  tiled.tile_side = 250;
  const Report report =
      send(random_points(3000, 9), *create_mesh(file("{x}_{y}.spm"), tiled, context), context,
           {.max_edge = 20});
  std::set<Point<3>> placed;
  for (const auto& [name, path] : files(".spm")) {
    MeshInMemory mesh;
    read(path, mesh, context);
    placed.insert(mesh.vertices().begin(), mesh.vertices().end());
  }
  EXPECT_GT(report.outside_vertices, 0U);
  EXPECT_EQ(report.outside_vertices, report.mesh.vertices - placed.size());
}

/// Before points are read, and not when the first tile is written.
TEST_F(MeshTiles, RefuseAFormatThatCannotHoldThemAtOnce) {
  const Context context(options());
  MeshFileOptions tiled;
  tiled.tile_side = 500;
  EXPECT_EQ(code_of([&] {
              send(random_points(1000, 10), *create_mesh(file("{x}_{y}.obj"), tiled, context),
                   context, {.input_index = true});
            }),
            ErrorCode::kInvalidArgument);
  EXPECT_THAT(phases_, ::testing::Not(::testing::Contains("triangulate")));
}

TEST_F(MeshTiles, OfOneNameAreRefused) {
  std::vector<Point<3>> points;
  for (int i = 0; i < 40; ++i) points.push_back({3e14 + 0.25 * i, 0.25 * (i % 7), 0});
  const Context context(options());
  MeshFileOptions tiled;
  tiled.tile_side = 0.5;
  EXPECT_EQ(
      code_of([&] { send(points, *create_mesh(file("{x}_{y}.ply"), tiled, context), context); }),
      ErrorCode::kInvalidArgument);
  EXPECT_THAT(files(".ply"), IsEmpty());
}

TEST_F(MeshTiles, RefuseWhatTheyCannotBe) {
  ContextOptions little = options();
  little.memory = "64M";
  const Context context(little);
  const auto refusal = [&](const std::string& pattern, const MeshFileOptions& how) {
    try {
      send(random_points(20000, 8), *create_mesh(file(pattern), how, context), context);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal("t.ply", {.tile_side = 10}), HasSubstr("tile_{x}_{y}.ply"));
  EXPECT_THAT(refusal("{x}_{y}.ply", {.tile_side = -1}), HasSubstr("a side above 0"));
  EXPECT_THAT(refusal("{x}_{y}.ply", {.tile_side = 1, .tile_polygons = "a.gpkg"}),
              HasSubstr("not both"));
  EXPECT_THAT(refusal("{x}_{y}.ply", {.tile_side = 1e-300}), HasSubstr("a larger side"));
  EXPECT_THAT(refusal("{x}_{y}.ply", {.tile_side = 1e-3}), HasSubstr("choose larger ones"));
  EXPECT_THAT(files(".ply"), IsEmpty());
}

}  // namespace
}  // namespace spillway::test

// The contract in four to six dimensions, out of core: whatever the tiles, the leaves, the threads
// and the order of the points, the stream holds the same simplices, which are CGAL's where these are the
// only ones.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "src/delaunay/delaunay.h"
#include "src/error.h"
#include "src/generators/generators.h"
#include "src/geometry/dimensions.h"
#include "tests/delaunay/cgal_oracle.h"
#include "tests/stream/stream_runner.h"

namespace spillway::test {
namespace {

/// Tiny tiles that fit into memory, tiny tiles that all go to the disk, one tile of many leaves.
std::vector<EngineOptions> many_ways(std::size_t points) {
  return {{.asked = {.tile_points = points / 12, .leaf_points = points / 30}, .threads = 1},
          {.asked = {.tile_points = points / 6, .leaf_points = points / 6},
           .threads = 2,
           .buffered_points = points / 4},
          {.asked = {.leaf_points = points / 5, .children = 4}, .threads = 4}};
}

template <int D>
using Simplices = std::vector<std::array<VertexId, D + 1>>;

/// What the engine in memory makes of the points at once.
template <int D>
Simplices<D> simplices_in_memory(const std::vector<Point<D>>& points) {
  Simplices<D> all;
  const Triangulation<D> mesh = delaunay_triangulation<D>(points, {.threads = 1});
  mesh.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
    if (simplex.infinite()) return;
    auto corners = simplex.vertices;
    for (VertexId& v : corners) v = mesh.input_index[v];
    std::sort(corners.begin(), corners.end());
    all.push_back(corners);
  });
  std::sort(all.begin(), all.end());
  return all;
}

template <int D>
void expect_stream_has(const std::vector<Point<D>>& points, const Simplices<D>& expected) {
  const std::string path = write_points<D>(points);
  for (const EngineOptions& options : many_ways(points.size())) {
    SCOPED_TRACE(::testing::Message()
                 << D << "D, " << points.size() << " points, tiles of " << options.asked.tile_points
                 << ", leaves of " << options.asked.leaf_points << ", " << options.threads
                 << " threads");
    const StreamRun run = run_stream<D>(path, options);
    ASSERT_TRUE(simplices_of<D>(run.mesh) == expected)
        << run.statistics.mesh.simplices << " simplices instead of " << expected.size();
    EXPECT_EQ(run.statistics.mesh.vertices + run.statistics.mesh.duplicates, points.size());
    EXPECT_EQ(run.mesh.live(), 0U) << "vertices never finalized";
    for (const MeshStreamBlock& block : run.mesh.blocks) {
      for (std::size_t v = 0; v < block.vertices.size(); ++v) {
        ASSERT_EQ(block.vertex<D>(v), points[block.input_index[v]]);
      }
    }
  }
  std::filesystem::remove(path);
}

/// Sets of that many points are done in less than a second.
std::uint64_t some_points(int dimension) {
  return dimension == 4 ? 500 : dimension == 5 ? 150 : 70;
}

/// A whole lattice.
std::uint64_t lattice_points(int dimension) {
  return dimension == 4 ? 256 : dimension == 5 ? 243 : 64;
}

/// As many points of lines or a sphere.
std::uint64_t cospherical_points(int dimension) {
  return dimension == 4 ? 200 : dimension == 5 ? 80 : 50;
}

class StreamOfHigherDimension : public ::testing::TestWithParam<int> {
 protected:
  template <typename F>
  static void for_dimension(F&& f) {
    with_dimension(GetParam(), [&](auto d) {
      if constexpr (d > 3) f(d);
    });
  }
};

TEST_P(StreamOfHigherDimension, EqualsCgalInTinyTiles) {
  for_dimension([](auto d) {
    for (const Family family : {Family::kUniform, Family::kNormal, Family::kBubbles,
                                Family::kEllipsoid, Family::kClusters}) {
      SCOPED_TRACE(family_names()[static_cast<std::size_t>(family)]);
      const auto points = generated_points<d>({.family = family, .count = some_points(d)});
      expect_stream_has<d>(points, cgal_simplices<d>(std::span<const Point<d>>(points)));
    }
  });
}

TEST_P(StreamOfHigherDimension, EqualsCgalWithDuplicates) {
  for_dimension([](auto d) {
    auto points = generated_points<d>({.count = some_points(d) / 2});
    const auto again = points;
    points.insert(points.end(), again.begin(), again.end());
    expect_stream_has<d>(points, cgal_simplices<d>(std::span<const Point<d>>(points)));
  });
}

TEST_P(StreamOfHigherDimension, EqualsTheEngineInMemoryOnCosphericalPoints) {
  for_dimension([](auto d) {
    for (const Family family : {Family::kLattice, Family::kCircle, Family::kLines}) {
      SCOPED_TRACE(family_names()[static_cast<std::size_t>(family)]);
      const std::uint64_t count =
          family == Family::kLattice ? lattice_points(d) : cospherical_points(d);
      const auto points = generated_points<d>({.family = family, .count = count});
      expect_stream_has<d>(points, simplices_in_memory<d>(points));
    }
  });
}

TEST_P(StreamOfHigherDimension, HasOneMeshWhateverTheOrderOfALattice) {
  for_dimension([](auto d) {
    auto points = generated_points<d>({.family = Family::kLattice, .count = lattice_points(d)});
    std::uint64_t hash = 0;
    for (const unsigned seed : {0U, 1U, 2U}) {
      std::shuffle(points.begin(), points.end(), std::mt19937_64(seed));
      const std::string path = write_points<d>(points);
      for (const EngineOptions& options : many_ways(points.size())) {
        const RunStatistics run = run_stream<d>(path, options).statistics;
        if (hash == 0) hash = run.mesh.canonical_hash;
        EXPECT_EQ(run.mesh.canonical_hash, hash);
      }
      std::filesystem::remove(path);
    }
  });
}

TEST_P(StreamOfHigherDimension, HasTheSameBlocksForAnyThreadCount) {
  for_dimension([](auto d) {
    const auto points = generated_points<d>({.count = some_points(d)});
    const std::string path = write_points<d>(points);
    EngineOptions options{.asked = {.tile_points = points.size() / 7}, .threads = 2};
    const StreamRun two = run_stream<d>(path, options);
    options.threads = 4;
    const StreamRun four = run_stream<d>(path, options);
    ASSERT_EQ(two.mesh.blocks.size(), four.mesh.blocks.size());
    for (std::size_t b = 0; b < two.mesh.blocks.size(); ++b) {
      ASSERT_EQ(two.mesh.blocks[b].vertices, four.mesh.blocks[b].vertices);
      ASSERT_EQ(two.mesh.blocks[b].attributes, four.mesh.blocks[b].attributes);
      ASSERT_EQ(two.mesh.blocks[b].imported, four.mesh.blocks[b].imported);
      ASSERT_EQ(two.mesh.blocks[b].corners, four.mesh.blocks[b].corners);
    }
    std::filesystem::remove(path);
  });
}

/// What is final inside of tiles and leaves is written before others are merged.
TEST(StreamOfFourDimensions, KeepsABorderInMemoryAndWritesTheRest) {
  const auto points = generated_points<4>({.count = 6'000});
  const std::string path = write_points<4>(points);
  const StreamRun run = run_stream<4>(
      path, {.asked = {.tile_points = 1'600}, .threads = 2, .buffered_points = 1'000});
  std::filesystem::remove(path);
  EXPECT_GT(run.statistics.spilled_points, 3'000U);
  EXPECT_GT(run.statistics.border_simplices, 0U);
  EXPECT_GT(run.statistics.final_in_leaves, run.statistics.mesh.simplices / 20);
  EXPECT_EQ(run.statistics.mesh.vertices, points.size());
}

/// Tiles are cut along x, y and z, so these may be equal throughout.
TEST(StreamOfFourDimensions, TriangulatesPointsOfFewPlaces) {
  std::vector<Point<4>> points;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> number;
  for (int i = 0; i < 400; ++i) {
    const auto site = static_cast<double>(i % 6);
    points.push_back({site, site * site, site * site * site, number(random)});
  }
  expect_stream_has<4>(points, simplices_in_memory<4>(points));
}

template <int D>
std::string failure_of(const std::vector<Point<D>>& points) {
  const std::string path = write_points<D>(points);
  try {
    run_stream<D>(path, {.threads = 1});
  } catch (const Failure& failure) {
    std::filesystem::remove(path);
    return failure.what();
  }
  return "";
}

TEST_P(StreamOfHigherDimension, RefusesPointsOfFewerDimensions) {
  for_dimension([](auto d) {
    EXPECT_EQ(failure_of<d>(generated_points<d>({.family = Family::kCollinear, .count = 50})),
              "all 50 points lie on one line: there is no simplex to make");
    EXPECT_EQ(failure_of<d>(generated_points<d>({.family = Family::kCoplanar, .count = 50})),
              "all 50 points lie in one space of fewer dimensions: there is no simplex to make");
  });
}

INSTANTIATE_TEST_SUITE_P(Of, StreamOfHigherDimension, ::testing::Values(4, 5, 6));

}  // namespace
}  // namespace spillway::test

// Generated points as a source: <spillway/generate.h>.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/generate.h>
#include <spillway/triangulate.h>

#include "tests/stream/library/call_test.h"

namespace spillway {
namespace {

using ::testing::Contains;

using Generated = test::CallTest;

TEST_F(Generated, PointsOfEveryFamilyComeInTheNumberThatWasAskedFor) {
  EXPECT_THAT(point_families(), Contains("terrain"));
  for (const std::string& family : point_families()) {
    const GenerateOptions what{.family = family, .count = 70'000, .seed = 3};
    const auto source = generate_points(what);
    EXPECT_EQ(source->header().count, 70'000U) << family;
    EXPECT_EQ(test::all_of(*source).size(), 70'000U) << family;
  }
}

TEST_F(Generated, PointsHaveHeightsInSpaceAndInTerrain) {
  EXPECT_EQ(generate_points({.family = "uniform"})->header().coordinates, 2);
  EXPECT_EQ(generate_points({.family = "uniform", .dimension = 3})->header().coordinates, 3);
  EXPECT_EQ(generate_points({.family = "terrain"})->header().coordinates, 3);
}

TEST_F(Generated, IntegersAreTriangulatedAsSuch) {
  const Context context(options());
  for (const char* family : {"lattice", "uniform"}) {
    const auto source = generate_points({.family = family, .count = 2000});
    MeshInMemory mesh;
    const Report report = triangulate(*source, mesh, {}, context);
    EXPECT_EQ(report.on_lattice, std::string(family) == "lattice");
    EXPECT_EQ(mesh.header().points, 2000U);
    EXPECT_EQ(report.points.read, 2000U);
  }
}

TEST_F(Generated, PointsThatAreNoneAreRefused) {
  EXPECT_EQ(code_of([] { generate_points({.family = "clouds"}); }), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code_of([] { generate_points({.dimension = 7}); }), ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace spillway

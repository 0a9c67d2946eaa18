// What files hold: <spillway/info.h>.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/convert.h>
#include <spillway/generate.h>
#include <spillway/info.h>
#include <spillway/triangulate.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "tests/stream/library/call_test.h"

namespace spillway {
namespace {

using ::testing::ElementsAre;

class Info : public test::CallTest {
 protected:
  void make_points(const std::string& name) {
    const Context context(options());
    const auto points = generate_points({.family = "terrain", .count = 5000});
    convert(*points, *create_points(file(name), {}, context), context);
    phases_.clear();
  }

  Report make_mesh(const std::string& name) {
    const Context context(options());
    const auto points = generate_points({.family = "terrain", .count = 5000});
    const Report report = triangulate(*points, *create_mesh(file(name), {}, context), {}, context);
    phases_.clear();
    return report;
  }
};

TEST_F(Info, OfPointsCountsWhatIsThere) {
  make_points("hills.las");
  const Context context(options());
  const PointsInfo info = describe_points(file("hills.las"), {}, context);
  EXPECT_EQ(info.format, "las");
  EXPECT_EQ(info.version, "1.2");
  EXPECT_EQ(info.point_format, 0);
  EXPECT_EQ(info.coordinates, 3);
  EXPECT_EQ(info.counts.kept(), 5000U);
  ASSERT_TRUE(info.lattice.has_value());
  EXPECT_EQ(info.lattice->scale[0], 0.01);
  ASSERT_TRUE(info.extent.has_value());
  EXPECT_THAT(phases_, ElementsAre("read"));
  PointOptions part;
  part.every = 10;
  EXPECT_EQ(describe_points(file("hills.las"), part, context).counts.kept(), 500U);
  part = {};
  part.bounds = Extent{{0, 0, 0}, {0, 0, 0}};
  EXPECT_FALSE(describe_points(file("hills.las"), part, context).extent.has_value());
}

TEST_F(Info, OfPointsTellsWhatTheyCarry) {
  const std::vector<Point<3>> points(3, Point<3>{1, 2, 3});
  const Attribute depth{.name = "depth",
                        .type = NumberType::kInt16,
                        .elements = 2,
                        .scale = 0.25,
                        .offset = 7,
                        .unit = "m",
                        .description = "below the surface"};
  const Context context(options());
  convert(*points_in_memory(points, AttributeColumns({depth}, 3)),
          *create_points(file("deep.spp"), {}, context), context);
  EXPECT_THAT(describe_points(file("deep.spp"), {}, context).attributes, ElementsAre(depth));
}

TEST_F(Info, OfPointsComparesThemWithTheBoxOfTheirHeader) {
  make_points("hills.las");
  const Context context(options());
  const auto write_most_x = [&](double most) {
    constexpr std::streamoff kMostX = 179;  // in a LAS header
    std::fstream bytes(file("hills.las"), std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(kMostX).write(reinterpret_cast<const char*>(&most), sizeof most);
  };
  const PointsInfo honest = describe_points(file("hills.las"), {}, context);
  EXPECT_EQ(honest.header_box, honest.extent);
  EXPECT_EQ(honest.points_outside, 0U);
  const auto [low, high] = *honest.extent;
  write_most_x(high[0] - 0.01);
  EXPECT_EQ(describe_points(file("hills.las"), {}, context).points_outside, 0U) << "a step";
  write_most_x((low[0] + high[0]) / 2);
  const PointsInfo lying = describe_points(file("hills.las"), {}, context);
  EXPECT_EQ(lying.extent, honest.extent);
  EXPECT_EQ(lying.header_box->high[0], (low[0] + high[0]) / 2);
  PointOptions right_half;
  right_half.bounds = Extent{{lying.header_box->high[0] + 0.015, low[1], low[2]}, high};
  EXPECT_EQ(lying.points_outside,
            describe_points(file("hills.las"), right_half, context).counts.kept());
}

TEST_F(Info, OfMeshesIsTheSameWhetherStreamsOrNot) {
  const Context context(options());
  for (const char* name : {"hills.spm", "hills.ply"}) {
    const Report made = make_mesh(name);
    const MeshInfo info = describe_mesh(file(name), {}, context);
    const bool is_stream = std::string(name) == "hills.spm";
    EXPECT_EQ(info.format, is_stream ? "spm" : "ply");
    EXPECT_EQ(info.dimension, 2);
    EXPECT_EQ(info.totals.vertices, made.mesh.vertices);
    EXPECT_EQ(info.totals.simplices, made.mesh.simplices);
    EXPECT_EQ(info.totals.hull_facets, made.mesh.hull_facets);
    EXPECT_EQ(info.totals.canonical_hash, made.mesh.canonical_hash);
    EXPECT_EQ(info.tells_totals, is_stream);
    EXPECT_EQ(info.totals.points, is_stream ? 5000U : 0U);
    EXPECT_EQ(info.peak_live_vertices.has_value(), is_stream);
    EXPECT_TRUE(info.lattice.has_value());
    EXPECT_TRUE(info.extent.has_value());
    EXPECT_THAT(phases_, ElementsAre("read"));
  }
}

TEST_F(Info, OfWhatIsNotThereOrCutShortIsAnError) {
  const Context context(options());
  EXPECT_EQ(code_of([&] { describe_points(file("none.las"), {}, context); }),
            ErrorCode::kInputOutput);
  make_mesh("hills.spm");
  std::filesystem::resize_file(file("hills.spm"),
                               std::filesystem::file_size(file("hills.spm")) - 40);
  EXPECT_EQ(code_of([&] { describe_mesh(file("hills.spm"), {}, context); }), ErrorCode::kBadInput);
}

}  // namespace
}  // namespace spillway

// Heights above the ground through the door for programs, against rational numbers.

#include <spillway/height.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/delaunay.h>
#include <spillway/input.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/stream/library/call_test.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using Wide = __int128;

/// Points of whole numbers below `side`.
std::vector<Point<3>> whole_points(std::size_t count, int side, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<Point<3>> points(count);
  for (Point<3>& p : points) {
    p = {static_cast<double>(random() % static_cast<unsigned>(side)),
         static_cast<double>(random() % static_cast<unsigned>(side)),
         static_cast<double>(random() % 1000)};
  }
  return points;
}

Wide area_of(const Point<3>& a, const Point<3>& b, const Point<3>& p) {
  return (Wide(b[0]) - Wide(a[0])) * (Wide(p[1]) - Wide(a[1])) -
         (Wide(b[1]) - Wide(a[1])) * (Wide(p[0]) - Wide(a[0]));
}

/// Heights above points of whole numbers: the triangle by the mesh in memory, the rest in rational
/// numbers, rounded once.
class ExactGround {
 public:
  explicit ExactGround(const std::vector<Point<3>>& points) : points_(points) {
    for (const Point<3>& p : points) plane_.push_back({p[0], p[1]});
    mesh_.emplace(plane_);
  }

  [[nodiscard]] std::optional<double> height(const Point<3>& p) const {
    const std::int32_t cell = mesh_->locate({p[0], p[1]});
    if (cell < 0) return std::nullopt;
    std::array<Point<3>, 3> t;
    for (int i = 0; i < 3; ++i) t[i] = points_[mesh_->cells()[cell].vertices[i]];
    const std::array<Wide, 3> parts = {area_of(t[1], t[2], p), area_of(t[2], t[0], p),
                                       area_of(t[0], t[1], p)};
    const Wide whole = parts[0] + parts[1] + parts[2];
    Wide sum = Wide(p[2]) * whole;
    for (int i = 0; i < 3; ++i) sum -= parts[i] * Wide(t[i][2]);
    return static_cast<double>(static_cast<long double>(sum) / static_cast<long double>(whole));
  }

 private:
  std::vector<Point<3>> points_;
  std::vector<Point<2>> plane_;
  std::optional<Delaunay<2>> mesh_;
};

/// A program's sink that keeps heights.
class HeightsInMemory : public PointSink {
 public:
  [[nodiscard]] std::vector<std::string> attributes_wanted() const override { return {"all"}; }
  void begin(const PointsHeader& told) override { header = told; }
  void write(std::span<const Point<3>> some) override {
    points.insert(points.end(), some.begin(), some.end());
  }
  void write(std::span<const Point<3>> some, const AttributeColumns& attributes) override {
    write(some);
    const std::span<const double> values = attributes.values<double>(kHeightAttribute);
    heights.insert(heights.end(), values.begin(), values.end());
  }

  PointsHeader header;
  std::vector<Point<3>> points;
  std::vector<double> heights;
};

class HeightAboveGround : public CallTest {
 protected:
  HeightReport measure(const std::vector<Point<3>>& points, const std::vector<Point<3>>& ground,
                       PointSink& sink, const HeightOptions& how = {},
                       std::optional<ContextOptions> given = {}) {
    const Context context(given ? *given : options());
    const auto source = points_in_memory(PointView<3>(points));
    const auto below = points_in_memory(PointView<3>(ground));
    return measure_heights(*source, *below, sink, how, {}, context);
  }
};

TEST_F(HeightAboveGround, IsExactInTrianglesOnEdgesVerticesAndOutside) {
  for (const int side : {40, 3000, 1'000'000}) {
    const std::vector<Point<3>> ground = whole_points(4000, side, 1);
    std::vector<Point<3>> points = whole_points(20'000, side, 2);
    for (Point<3>& p : points) p[0] -= side / 50;
    points.insert(points.end(), ground.begin(), ground.end());
    HeightsInMemory sink;
    const HeightReport report = measure(points, ground, sink);
    EXPECT_EQ(sink.points, points);  // all of them, in their order
    const ExactGround exact(ground);
    std::uint64_t outside = 0;
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::optional<double> height = exact.height(points[i]);
      outside += height ? 0 : 1;
      below += height && *height < 0 ? 1 : 0;
      ASSERT_NEAR(sink.heights[i], height.value_or(-9999), 1e-6) << i;
    }
    EXPECT_EQ(report.without_ground, outside);
    EXPECT_GT(outside, 0U);
    EXPECT_NEAR(static_cast<double>(report.below_ground), static_cast<double>(below), 1);
    EXPECT_EQ(report.points.written, points.size());
  }
}

TEST_F(HeightAboveGround, DoesNotDependOnMemoryOrThreads) {
  const std::vector<Point<3>> ground = whole_points(200'000, 100'000, 3);
  const std::vector<Point<3>> points = whole_points(900'000, 100'000, 4);
  HeightsInMemory usual;
  measure(points, ground, usual);
  ContextOptions small = options();
  small.memory = "64M";
  small.threads = 1;
  HeightsInMemory other;
  const HeightReport report = measure(points, ground, other, {}, small);
  EXPECT_GT(report.spilled_bytes, 0U);
  EXPECT_EQ(other.points, usual.points);
  EXPECT_EQ(other.heights, usual.heights);
}

TEST_F(HeightAboveGround, TakesThePlaceOfZ) {
  const std::vector<Point<3>> ground = {{0, 0, 10}, {9, 0, 10}, {0, 9, 10}, {9, 9, 10}};
  const std::vector<Point<3>> points = {{1, 1, 12.5}, {20, 20, 7}, {9, 9, 9}};
  OwnSink sink;
  measure(points, ground, sink, {.replace_z = true, .nodata = -1});
  EXPECT_EQ(sink.points, (std::vector<Point<3>>{{1, 1, 2.5}, {20, 20, -1}, {9, 9, -1}}));
  EXPECT_TRUE(sink.header.attributes.empty());
}

TEST_F(HeightAboveGround, ChoosesPointsAndCountsTheOthers) {
  const std::vector<Point<3>> ground = {{0, 0, 10}, {9, 0, 10}, {0, 9, 10}, {9, 9, 10}};
  const std::vector<Point<3>> points = {{1, 1, 12}, {2, 1, 13}, {3, 1, 14}, {20, 20, 13}};
  HeightsInMemory sink;
  const HeightReport report = measure(points, ground, sink, {.min_height = 2.5, .max_height = 3.5});
  EXPECT_EQ(sink.points, (std::vector<Point<3>>{{2, 1, 13}}));
  EXPECT_EQ(sink.heights, (std::vector<double>{3}));
  EXPECT_EQ(report.other_heights, 3U);
  EXPECT_EQ(report.without_ground, 1U);
  EXPECT_EQ(report.points.written, 1U);
  EXPECT_EQ(report.lowest, 2);
  EXPECT_EQ(report.highest, 4);
}

TEST_F(HeightAboveGround, IsMeasuredOfAProgramsPointsWithWhatTheyCarry) {
  const std::vector<Point<3>> ground = whole_points(3000, 1000, 5);
  const std::vector<Point<3>> points = whole_points(70'000, 1000, 6);
  HeightsInMemory usual;
  measure(points, ground, usual);
  const Context context(options());
  OwnPoints source(points);
  OwnPoints below(ground);
  HeightsInMemory own;
  const HeightReport report = measure_heights(source, below, own, {}, {}, context);
  EXPECT_EQ(own.heights, usual.heights);
  EXPECT_GT(report.spilled_bytes, 0U);
}

TEST_F(HeightAboveGround, ReplacesAnAttributeOfItsName) {
  const Context context(options());
  const std::vector<Point<3>> points = {{1, 1, 12}, {2, 2, 15}};
  AttributeColumns carried({{.name = kHeightAttribute}, {.name = "weight"}}, points.size());
  std::ranges::copy(std::vector<double>{5, 6}, carried.values<double>(kHeightAttribute).begin());
  const auto source = points_in_memory(PointView<3>(points), carried);
  const std::vector<Point<3>> ground = {{0, 0, 10}, {9, 0, 10}, {0, 9, 10}};
  const auto below = points_in_memory(PointView<3>(ground));
  HeightsInMemory sink;
  measure_heights(*source, *below, sink, {}, {}, context);
  EXPECT_EQ(sink.heights, (std::vector<double>{2, 5}));
  ASSERT_EQ(sink.header.attributes.size(), 2U);
  EXPECT_EQ(sink.header.attributes[0].name, "weight");
}

TEST_F(HeightAboveGround, IsTheSameAboveAMeshOfTheGround) {
  const std::vector<Point<3>> ground = whole_points(5000, 2000, 7);
  const std::vector<Point<3>> points = whole_points(30'000, 2200, 8);
  HeightsInMemory usual;
  measure(points, ground, usual);
  const Context context(options());
  for (const char* const name : {"ground.spm", "ground.ply"}) {
    const auto below = points_in_memory(PointView<3>(ground));
    triangulate(*below, *create_mesh(file(name), {}, context), {}, context);
    const auto mesh = open_mesh(file(name), {}, context);
    const auto source = points_in_memory(PointView<3>(points));
    HeightsInMemory sink;
    measure_heights(*source, *mesh, sink, {}, context);
    EXPECT_EQ(sink.heights, usual.heights) << name;
  }
}

TEST_F(HeightAboveGround, LeavesWhatLongEdgesSpanWithoutGround) {
  const std::vector<Point<3>> ground = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {100, 100, 0}};
  const std::vector<Point<3>> points = {{0.25, 0.25, 1}, {50, 50, 1}};
  const Context context(options());
  const auto source = points_in_memory(PointView<3>(points));
  const auto below = points_in_memory(PointView<3>(ground));
  HeightsInMemory sink;
  const HeightReport report =
      measure_heights(*source, *below, sink, {}, {.max_edge = 5.0}, context);
  EXPECT_EQ(sink.heights, (std::vector<double>{1, -9999}));
  EXPECT_EQ(report.without_ground, 1U);
}

TEST_F(HeightAboveGround, IsZOfPointsToBeTriangulated) {
  const Context context(options());
  const std::vector<Point<3>> points = {{0, 0, 10}, {9, 0, 10}, {0, 9, 10}, {9, 9, 10},
                                        {4, 4, 17}, {3, 1, 9},  {20, 3, 12}};
  AttributeColumns carried({{.name = "classification", .type = NumberType::kUint8}}, points.size());
  for (std::size_t i = 0; i < 4; ++i) carried.values<std::uint8_t>("classification")[i] = 2;
  convert(*points_in_memory(PointView<3>(points), carried),
          *create_points(file("a.spp"), {}, context), context);
  {
    const PointsAboveGround above =
        open_above_ground({file("a.spp")}, {}, {2}, {.min_height = 0.0}, {}, context);
    EXPECT_EQ(above.report.without_ground, 1U);
    EXPECT_EQ(above.report.other_heights, 2U);
    EXPECT_EQ(all_of(*above.points),
              (std::vector<Point<3>>{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {9, 9, 0}, {4, 4, 7}}));
  }
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& left : std::filesystem::recursive_directory_iterator(folder_)) {
    ++files;
  }
  EXPECT_EQ(files, 1U);  // the points
}

TEST_F(HeightAboveGround, RefusesOptionsThatCannotBe) {
  const std::vector<Point<3>> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  HeightsInMemory sink;
  const auto refusal = [&](const HeightOptions& how) {
    try {
      measure(points, points, sink, how);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(refusal({.min_height = 3, .max_height = 2}), HasSubstr("no height is 3"));
  EXPECT_THAT(refusal({.replace_z = true, .nodata = std::nan("")}),
              HasSubstr("need a number as z"));
  ContextOptions small = options();
  small.memory = "40M";
  try {
    measure(points, points, sink, {}, small);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kOutOfBudget);
    EXPECT_THAT(error.what(), HasSubstr("64 MiB are the least"));
  }
}

TEST_F(HeightAboveGround, TakesPointsAndGroundWithHeightsOnly) {
  const std::vector<Point<2>> flat = {{0, 0}, {1, 0}, {0, 1}};
  const std::vector<Point<3>> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Context context(options());
  HeightsInMemory sink;
  for (const bool flat_ground : {true, false}) {
    const auto without = points_in_memory(PointView<2>(flat));
    const auto with = points_in_memory(PointView<3>(points));
    PointSource& source = flat_ground ? *with : *without;
    PointSource& ground = flat_ground ? *without : *with;
    try {
      measure_heights(source, ground, sink, {}, {}, context);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kDegenerateInput);
    }
  }
}

}  // namespace
}  // namespace spillway::test

// Volumes between surfaces through the door for programs.

#include <spillway/volume.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/convert.h>
#include <spillway/triangulate.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/stream/library/call_test.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;
using HeightOf = std::function<double(double x, double y)>;

/// A square of side 1000, corners included.
std::vector<Point<3>> surface(std::size_t count, unsigned seed, const HeightOf& height) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(0, 1000);
  std::vector<Point<3>> points;
  for (const double x : {0.0, 1000.0}) {
    for (const double y : {0.0, 1000.0}) points.push_back({x, y, height(x, y)});
  }
  while (points.size() < count) {
    const double x = place(random);
    const double y = place(random);
    points.push_back({x, y, height(x, y)});
  }
  return points;
}

double tilted(double x, double y) { return 100 + 0.03 * x - 0.01 * y; }
double level(double /*x*/, double /*y*/) { return 110; }
double hills(double x, double y) { return 110 + 8 * std::sin(x / 70) * std::cos(y / 50); }

class VolumeOf : public CallTest {
 protected:
  static Report send(const std::vector<Point<3>>& points, MeshSink& sink, const Context& context) {
    const auto source = points_in_memory(PointView<3>(points));
    return triangulate(*source, sink, {}, context);
  }

  static Volume between(const std::vector<Point<3>>& first, const std::vector<Point<3>>& second,
                        const Context& context, const VolumeOptions& options = {}) {
    const auto volume = measure_between(options, context);
    send(first, volume->first(), context);
    send(second, volume->second(), context);
    return volume->measure();
  }
};

TEST_F(VolumeOf, TwoPlanesIsThatOfTheWedgesBetweenThem) {
  const Context context(options());
  const auto first = surface(20'000, 1, tilted);
  const auto second = surface(9'000, 2, level);
  const Volume volume = between(first, second, context);
  EXPECT_NEAR(volume.area, 1e6, 1e-3);
  EXPECT_NEAR(volume.first_area, 1e6, 1e-3);
  EXPECT_NEAR(volume.second_area, 1e6, 1e-3);
  EXPECT_NEAR(volume.net(), 0, 1e-3);  // 0.03 * 500 - 0.01 * 500 is 10
  EXPECT_NEAR(volume.cut_area + volume.fill_area, 1e6, 1e-3);
  EXPECT_NEAR(volume.cut, volume.fill, 1e-3);
  const auto sink = measure_above(110, {}, context);
  send(first, *sink, context);
  EXPECT_NEAR(sink->volume().cut, volume.cut, 1e-3);
  EXPECT_NEAR(sink->volume().cut_area, volume.cut_area, 1e-3);
}

TEST_F(VolumeOf, SurfacesHasTheSameBitsForAllThreadsAndMemories) {
  const auto first = surface(150'000, 3, hills);
  const auto second = surface(120'000, 4, tilted);
  ContextOptions large = options();
  large.memory = "512M";
  const Context usual(large);
  const Volume expected = between(first, second, usual);
  ContextOptions small = options();
  small.memory = "64M";
  small.threads = 1;
  const Context other(small);
  const Volume volume = between(first, second, other);
  EXPECT_EQ(volume.cut, expected.cut);
  EXPECT_EQ(volume.fill, expected.fill);
  EXPECT_EQ(volume.cut_area, expected.cut_area);
  EXPECT_EQ(volume.area, expected.area);
  EXPECT_GT(volume.spilled_bytes, 0U);
  EXPECT_EQ(expected.spilled_bytes, 0U);
  EXPECT_NEAR(volume.area, 1e6, 1e-3);
}

TEST_F(VolumeOf, MeshesIsThatOfTheirPoints) {
  const Context context(options());
  const auto first = surface(5000, 5, hills);
  const auto second = surface(4000, 6, tilted);
  const Volume expected = between(first, second, context);
  const auto volume = measure_between({}, context);
  for (const auto& [points, name, sink] : {std::tuple(&first, "a.spm", &volume->first()),
                                           std::tuple(&second, "b.ply", &volume->second())}) {
    const auto mesh = create_mesh(file(name), {}, context);
    send(*points, *mesh, context);
    const auto source = open_mesh(file(name), {}, context);
    convert(*source, *sink, context);
  }
  EXPECT_EQ(volume->measure().cut, expected.cut);
  EXPECT_EQ(volume->measure().fill, expected.fill);
}

TEST_F(VolumeOf, SurfacesWithPointsFarAwayIsThatWithoutThem) {
  const Context context(options());
  auto first = surface(30'000, 9, hills);
  auto second = surface(30'000, 10, tilted);
  const Volume near = between(first, second, context);
  first.push_back({5e6, 2e6, 110});
  second.push_back({-4e6, 3e6, 110});
  const Volume far = between(first, second, context);
  EXPECT_GE(far.area, near.area - 1e-3);
  EXPECT_GE(far.cut, near.cut - 1e-3);  // triangles to those points cover each other, too
}

TEST_F(VolumeOf, SurfacesBesideEachOtherIsNothing) {
  const Context context(options());
  const auto first = surface(500, 7, level);
  auto second = first;
  for (Point<3>& p : second) p[0] += 5000;
  const Volume volume = between(first, second, context);
  EXPECT_EQ(volume.area, 0);
  EXPECT_EQ(volume.cut, 0);
  EXPECT_NEAR(volume.second_area, 1e6, 1e-3);
}

TEST_F(VolumeOf, SurfacesLeavesOutLongEdgesOfMeshesAndScalesHeights) {
  const Context context(options());
  const std::vector<Point<3>> points = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {50, 50, 1}};
  const auto mesh = create_mesh(file("a.spm"), {}, context);
  send(points, *mesh, context);
  const auto source = open_mesh(file("a.spm"), {}, context);
  const auto sink = measure_above(0, {.max_edge = 10.0, .z_factor = 3.0}, context);
  const Report report = convert(*source, *sink, context);
  EXPECT_EQ(report.left_out, 1U);
  EXPECT_EQ(sink->volume().cut, 1.5);
}

TEST_F(VolumeOf, SurfacesTakesBothInTheirOrder) {
  const Context context(options());
  const auto points = surface(100, 8, level);
  const auto volume = measure_between({}, context);
  EXPECT_THROW(volume->measure(), Error);
  EXPECT_THROW(send(points, volume->second(), context), Error);
  EXPECT_THROW(measure_between({.z_factor = 0.0}, context), Error);
  EXPECT_THROW(measure_above(std::nan(""), {}, context), Error);
}

}  // namespace
}  // namespace spillway::test

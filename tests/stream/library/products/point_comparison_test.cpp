// Whether a mesh has exactly the input's points, out of core: missing, extra and moved vertices,
// wrong heights.

#include "stream/library/products/point_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <random>

#include "stream/source/joined_inputs.h"

namespace spillway::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Points = std::vector<Point<3>>;

Points random_points(std::size_t count) {
  std::mt19937_64 random(3);
  Points points(count);
  for (Point<3>& p : points) {
    for (double& x : p) x = static_cast<double>(random() % 1'000'000);
  }
  return points;
}

/// Compares in so little memory that both sides are spilled.
CheckReport compare(const Points& vertices, const Points& input, int dimension) {
  const std::string path = ::testing::TempDir() + "compared" + std::to_string(::getpid()) + ".txt";
  std::ofstream file(path);
  file.precision(17);
  for (const Point<3>& p : input) file << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  file.close();
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  PointComparison comparison(dimension, 1 << 18, *scratch);
  for (const Point<3>& vertex : vertices) comparison.add_vertex(WorldPoint(vertex), {});
  JoinedInputs source(disk(), {path}, {.dimension = dimension, .index = true});
  CheckReport report;
  const Context silent;
  RunWatch watch(silent);
  comparison.compare(source, {}, report, watch);
  ::unlink(path.c_str());
  return report;
}

class PointComparisonIn : public ::testing::TestWithParam<int> {};

TEST_P(PointComparisonIn, ProvesEqualSetsWhateverTheOrderAndTheDuplicates) {
  const Points vertices = random_points(20'000);
  Points input(vertices.rbegin(), vertices.rend());
  input.push_back(vertices[4]);
  const CheckReport report = compare(vertices, input, GetParam());
  EXPECT_THAT(report.faults, IsEmpty());
  EXPECT_THAT(report.proved, Contains(HasSubstr("the 20000 distinct points of the input")));
}

TEST_P(PointComparisonIn, NamesAnInputPointThatIsNoVertex) {
  const Points vertices = random_points(10'000);
  Points input = vertices;
  input.push_back({0.5, 0.5, 0.5});
  const CheckReport report = compare(vertices, input, GetParam());
  EXPECT_EQ(report.fault_count, 1U);
  EXPECT_THAT(report.faults, Contains(HasSubstr("input point 10000 (0.5, 0.5")));
  EXPECT_THAT(report.proved, IsEmpty());
}

TEST_P(PointComparisonIn, NamesAVertexThatIsNoInputPoint) {
  const Points vertices = random_points(10'000);
  const CheckReport report =
      compare(vertices, Points(vertices.begin(), vertices.end() - 1), GetParam());
  EXPECT_EQ(report.fault_count, 1U);
  EXPECT_THAT(report.faults, Contains(HasSubstr("vertex 9999 (")));
}

TEST_P(PointComparisonIn, SeesAMovedVertexFromBothSides) {
  Points vertices = random_points(5'000);
  const Points input = vertices;
  vertices[77][1] += 0.25;
  EXPECT_EQ(compare(vertices, input, GetParam()).fault_count, 2U);
}

TEST_P(PointComparisonIn, FoldsMoreEqualPointsThanATileHas) {
  Points vertices = random_points(100);
  Points input = vertices;
  input.insert(input.end(), 20'000, vertices[7]);
  EXPECT_THAT(compare(vertices, input, GetParam()).proved,
              Contains(HasSubstr("the 100 distinct points of the input")));

  const Point<3> lacking = vertices[7];
  vertices.erase(vertices.begin() + 7);
  const CheckReport without = compare(vertices, input, GetParam());
  EXPECT_EQ(without.fault_count, 1U);
  EXPECT_THAT(without.faults, Contains(HasSubstr("input point 7 (")));

  vertices.insert(vertices.end(), 20'000, lacking);
  EXPECT_EQ(compare(vertices, random_points(100), GetParam()).fault_count, 19'999U);
}

TEST(PointComparison, SeesAWrongHeightAmongMoreEqualPointsThanATileHas) {
  Points vertices = random_points(100);
  Points input = vertices;
  for (int i = 0; i < 20'000; ++i) {
    input.push_back({vertices[7][0], vertices[7][1], vertices[7][2] + i});
  }
  vertices[7][2] += 500;
  EXPECT_EQ(compare(vertices, input, 2).fault_count, 0U);
  vertices[7][2] -= 501;
  EXPECT_THAT(compare(vertices, input, 2).faults, Contains(HasSubstr("vertex 7 (")));
}

INSTANTIATE_TEST_SUITE_P(Dimensions, PointComparisonIn, ::testing::Values(2, 3));

TEST(PointComparison, SeesAWrongHeight) {
  Points vertices = random_points(5'000);
  const Points input = vertices;
  vertices[1234][2] = 1e7;
  const CheckReport report = compare(vertices, input, 2);
  EXPECT_EQ(report.fault_count, 1U);
  EXPECT_THAT(report.faults, Contains(HasSubstr("vertex 1234 (")));
  EXPECT_THAT(report.faults, Contains(HasSubstr("has height 10000000")));
}

TEST(PointComparison, AcceptsAnyHeightBetweenThoseOfThePlace) {
  const Points input = {{0, 0, 2}, {0, 0, 11}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(compare({{0, 0, 6}, {1, 0, 0}, {0, 1, 0}}, input, 2).fault_count, 0U);
}

}  // namespace
}  // namespace spillway::test

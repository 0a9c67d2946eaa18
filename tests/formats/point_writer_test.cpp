#include "formats/point_writer.h"

#include <cmath>
#include <limits>
#include <random>

#include "tests/formats/point_test_helpers.h"

namespace spillway::testing {
namespace {

using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

constexpr Lattice kCentimetres{{0.01, 0.01, 0.01}, {500000, 4000000, -10}};

/// What a writer makes of the points, written in two pieces.
std::string written(const std::string& path, const std::vector<Point<3>>& points,
                    PointWriterOptions options, bool seekable = true) {
  FaultyFileSystem files;
  files.seekable = seekable;
  options.count = points.size();
  const auto writer = open_point_writer(files, path, options);
  const std::span<const Point<3>> all = points;
  writer->write(all.first(all.size() / 3));
  writer->write(all.subspan(all.size() / 3));
  EXPECT_TRUE(files.files.empty());
  writer->finish();
  EXPECT_TRUE(files.parts.empty());
  return files.files.at(path);
}

PointWriterOptions with_lattice(const Lattice& lattice) {
  PointWriterOptions options;
  options.lattice = lattice;
  return options;
}

std::vector<Point<3>> random_integers(std::size_t count) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int32_t> any;
  std::vector<Point<3>> points(count);
  for (Point<3>& p : points) p = {double(any(random)), double(any(random)), double(any(random))};
  points[0] = {std::numeric_limits<std::int32_t>::min(), 0, 0};
  points[1] = {0, std::numeric_limits<std::int32_t>::max(), -1};
  return points;
}

std::vector<Point<3>> random_doubles(std::size_t count) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-300, 300);
  std::vector<Point<3>> points(count);
  for (Point<3>& p : points) {
    for (double& c : p) c = mantissa(random) * std::pow(10.0, exponent(random));
  }
  return points;
}

TEST(LasWriter, RoundTrip) {
  const std::vector<Point<3>> points = random_integers(20000);
  const AllPoints back =
      read_content("a.las", written("a.las", points, with_lattice(kCentimetres)));
  EXPECT_THAT(back.points, ElementsAreArray(points));
  EXPECT_EQ(back.header.version, "1.2");
  EXPECT_EQ(back.header.point_format, 0);
  EXPECT_EQ(back.header.lattice, kCentimetres);
  EXPECT_EQ(back.header.software, "Spillway");
}

TEST(LasWriter, BoundsAreTightOnAFile) {
  const std::string bytes =
      written("a.las", {{100, 200, 300}, {-100, 400, 0}}, with_lattice(kCentimetres));
  EXPECT_EQ(read_content("a.las", bytes).header.extent,
            (Box<3>{{499999, 4000002, -10}, {500001, 4000004, -7}}));
}

TEST(LasWriter, BoundsOnAPipeHoldAllIntegers) {
  const std::string bytes =
      written("a.las", {{100, 200, 300}, {-100, 400, 0}}, with_lattice({}), false);
  constexpr double kLeast = std::numeric_limits<std::int32_t>::min();
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(read_content("a.las", bytes).header.extent,
            (Box<3>{{kLeast, kLeast, kLeast}, {kMost, kMost, kMost}}));
}

TEST(LasWriter, NoPoints) {
  EXPECT_TRUE(read_content("a.las", written("a.las", {}, with_lattice({}))).points.empty());
}

TEST(LasWriter, MoreThan32BitsCountPointsMakeVersion14) {
  FaultyFileSystem files;
  files.seekable = false;
  PointWriterOptions options = with_lattice({});
  options.count = (std::uint64_t{1} << 32) + 5;
  const auto writer = open_point_writer(files, "a.las", options);
  files.files["a.las"] = files.parts.at("a.las");
  const PointHeader header = open_point_reader(files, "a.las", {})->header();
  EXPECT_EQ(header.version, "1.4");
  EXPECT_EQ(header.count, options.count);
}

TEST(LasWriter, RefusesWhatIsNoInt32) {
  for (const double bad :
       {0.5, 2147483648.0, -2147483649.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(error_of([&] {
                  written("a.las", {{0, 0, 0}, {0, 0, 0}, {1, bad, 1}}, with_lattice({}));
                }),
                HasSubstr("a.las: point 2 (1, "));
  }
}

TEST(LasWriter, NeedsALatticeAndThreeCoordinates) {
  EXPECT_THAT(error_of([] { written("a.las", {}, {}); }), HasSubstr("write text or npy"));
  PointWriterOptions flat = with_lattice({});
  flat.coordinates = 2;
  EXPECT_THAT(error_of([&] { written("a.las", {}, flat); }), HasSubstr("three coordinates"));
}

TEST(TextWriter, RoundTripOfDoubles) {
  const std::vector<Point<3>> points = random_doubles(20000);
  EXPECT_THAT(read_content("a.xyz", written("a.xyz", points, {})).points, ElementsAreArray(points));
}

TEST(TextWriter, TwoColumns) {
  PointWriterOptions flat;
  flat.coordinates = 2;
  EXPECT_EQ(written("a.txt", {{1, 2.5, 0}, {-3, 4, 0}}, flat), "1 2.5\n-3 4\n");
}

TEST(TextWriter, CommasInCsv) { EXPECT_EQ(written("a.csv", {{1, 2.5, 0}}, {}), "1,2.5,0\n"); }

TEST(TextWriter, DecimalsOfTheLattice) {
  EXPECT_EQ(
      written("a.xyz", {{1234, -400000001, 0}, {-50000001, 5, 999}}, with_lattice(kCentimetres)),
      "500012.34 -0.01 -10.00\n-0.01 4000000.05 -0.01\n");
  EXPECT_EQ(written("a.xyz", {{1, 2, -3}}, with_lattice({})), "1 2 -3\n");
}

TEST(TextWriter, WorldCoordinatesWhereTheLatticeIsNotDecimal) {
  const Lattice odd{{0.25, 1.0 / 3, 0.01}, {0, 0, 0.005}};
  EXPECT_EQ(written("a.xyz", {{3, 1, 1}}, with_lattice(odd)), "0.75 0.3333333333333333 0.015\n");
}

TEST(NpyWriter, RoundTrip) {
  const std::vector<Point<3>> points = random_doubles(20000);
  const std::string bytes = written("a.npy", points, {});
  EXPECT_EQ((bytes.size() - points.size() * 24) % 64, 0U);
  EXPECT_THAT(read_content("a.npy", bytes).points, ElementsAreArray(points));
}

TEST(NpyWriter, TwoColumns) {
  PointWriterOptions flat;
  flat.coordinates = 2;
  const AllPoints back = read_content("a.npy", written("a.npy", {{1, 2.5, 0}, {-3, 4, 0}}, flat));
  EXPECT_EQ(back.header.coordinates, 2);
  EXPECT_EQ(back.points[1], (Point<3>{-3, 4, 0}));
}

TEST(NpyWriter, WorldCoordinatesOfLatticePoints) {
  const AllPoints back =
      read_content("a.npy", written("a.npy", {{100, 200, 300}}, with_lattice(kCentimetres)));
  EXPECT_EQ(back.points[0], (Point<3>{500001, 4000002, -7}));
}

TEST(PointWriter, RefusesAnotherNumberOfPoints) {
  for (const char* path : {"a.las", "a.xyz", "a.npy", "a.spp"}) {
    FaultyFileSystem files;
    PointWriterOptions options = with_lattice({});
    options.count = 3;
    auto writer = open_point_writer(files, path, options);
    writer->write(std::vector<Point<3>>(2));
    EXPECT_THAT(error_of([&] { writer->finish(); }),
                HasSubstr("3 points were promised, but 2 came"));
    writer.reset();
    EXPECT_TRUE(files.files.empty());
    EXPECT_TRUE(files.parts.empty());
  }
}

}  // namespace
}  // namespace spillway::testing

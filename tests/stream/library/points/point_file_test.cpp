// A point file in the making: what it is rounded to, and which version of LAS it is.

#include "stream/library/points/point_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/inputs/open_points.h"
#include "tests/formats/inputs/temporary_files.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;

class PointFileTest : public ::testing::Test {
 protected:
  static PointBlock block(std::vector<LatticePoint> points, std::uint64_t first = 0) {
    PointBlock block;
    block.points = std::move(points);
    for (std::size_t i = 0; i < block.size(); ++i) block.index.push_back(first + i);
    return block;
  }

  /// A file of these points, in blocks as they are.
  PointConversion write(const std::string& name, const RunPoints& points,
                        std::vector<PointBlock> blocks, const PointFileOptions& how = {}) {
    PointFile file(files_.path(name), how, context_);
    file.start(points);
    for (PointBlock& some : blocks) file.append(some);
    return file.complete();
  }

  [[nodiscard]] PointHeader header_of(const std::string& name) const {
    return open_point_reader(disk(), files_.path(name), {})->header();
  }

  TemporaryFiles files_;
  const Context context_;
};

TEST_F(PointFileTest, WithoutAnExtentIsRoundedAroundItsFirstPoints) {
  const PointConversion done = write(
      "a.las", {},
      {block({}), block({{5e6, 9e6, 1}, {5e6 + 10, 9e6, 2}}), block({{5e6, 9e6 + 500, 3}}, 2)});
  EXPECT_EQ(done.written, 3U);
  EXPECT_TRUE(done.rounded);
  EXPECT_THAT(done.scale, ElementsAre(0.001, 0.001, 0.001));
  EXPECT_THAT(done.offset, ElementsAre(5e6, 9e6, 0));
  EXPECT_LE(done.farthest, 0.0005 + 1e-9);
}

TEST_F(PointFileTest, WithAnExtentIsRoundedAroundItsMiddle) {
  RunPoints points;
  points.extent = Box<3>{{4e6, 8e6, 0}, {6e6, 10e6, 9}};
  const PointConversion done = write("a.las", points, {block({{4e6, 8e6, 1}})});
  EXPECT_THAT(done.offset, ElementsAre(5e6, 9e6, 0));
}

TEST_F(PointFileTest, WithoutPointsIsAFileAllTheSame) {
  EXPECT_EQ(write("a.las", {}, {}).written, 0U);
  EXPECT_EQ(header_of("a.las").count, 0U);
}

PointHeader las(int point_format) {
  PointHeader header;
  header.format = "las";
  header.point_format = point_format;
  return header;
}

TEST_F(PointFileTest, IsOfTheVersionOfLasThatItsPointsNeed) {
  RunPoints old;
  old.headers = {las(1), las(3)};
  write("old.las", old, {block({{1, 2, 3}})});
  EXPECT_EQ(header_of("old.las").version, "1.2");
  RunPoints extended = old;
  extended.headers.push_back(las(6));
  write("extended.las", extended, {block({{1, 2, 3}})});
  EXPECT_EQ(header_of("extended.las").version, "1.4");
  write("chosen.las", extended, {block({{1, 2, 3}})}, {.las_version = "1.2"});
  EXPECT_EQ(header_of("chosen.las").version, "1.2");
}

TEST_F(PointFileTest, HasHeightsWhereItsFormatWantsThem) {
  RunPoints flat;
  flat.has_heights = false;
  EXPECT_TRUE(write("a.las", flat, {block({{1, 2, 0}})}).adds_heights);
  EXPECT_FALSE(write("a.npy", flat, {block({{1, 2, 0}})}).adds_heights);
  EXPECT_EQ(header_of("a.npy").coordinates, 2);
}

}  // namespace
}  // namespace spillway::test

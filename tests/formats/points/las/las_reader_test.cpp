#include <fmt/format.h>

#include <array>
#include <limits>
#include <tuple>
#include <utility>

#include "formats/inputs/open_points.h"
#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/las/las_file.h"

namespace spillway::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// (minor version, point format)
class LasFormats : public ::testing::TestWithParam<std::tuple<int, int>> {
 protected:
  LasFormats() {
    file_.minor = std::get<0>(GetParam());
    file_.point_format = std::get<1>(GetParam());
  }
  LasFile file_;
};

TEST_P(LasFormats, GivesIntegersAndDropsWithheldPoints) {
  const AllPoints all = read_content("a.las", file_.bytes());
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 3}, LatticePoint{7, -8, 9}));
  EXPECT_THAT(all.index, ElementsAre(0, 2));
  EXPECT_EQ(all.withheld, 1U);
}

TEST_P(LasFormats, KeepsWithheldPointsOnDemand) {
  const AllPoints all = read_content("a.las", file_.bytes(), {"", true});
  EXPECT_THAT(all.points,
              ElementsAre(LatticePoint{1, 2, 3}, LatticePoint{-4, 5, -6}, LatticePoint{7, -8, 9}));
  EXPECT_EQ(all.withheld, 0U);
}

TEST_P(LasFormats, StepsOverExtraBytes) {
  file_.extra_bytes = 5;
  EXPECT_THAT(read_content("a.las", file_.bytes()).points,
              ElementsAre(LatticePoint{1, 2, 3}, LatticePoint{7, -8, 9}));
}

TEST_P(LasFormats, TellsWhatTheHeaderSays) {
  const PointHeader header = read_content("a.las", file_.bytes()).header;
  EXPECT_EQ(header.name, "a.las");
  EXPECT_EQ(header.format, "las");
  EXPECT_EQ(header.version, fmt::format("1.{}", file_.minor));
  EXPECT_EQ(header.point_format, file_.point_format);
  EXPECT_EQ(header.coordinates, 3);
  EXPECT_EQ(header.count, 3U);
  EXPECT_EQ(header.lattice, (IntegerLattice{file_.scale, file_.offset}));
  EXPECT_EQ(header.extent, (Box<3>{{10, 30, 50}, {20, 40, 60}}));
  EXPECT_EQ(header.software, "by hand");
}

INSTANTIATE_TEST_SUITE_P(All, LasFormats,
                         ::testing::Combine(::testing::Range(0, 5), ::testing::Range(0, 11)));

TEST(LasReader, TakesTheLongCountWhereItIsGiven) {
  LasFile file;
  file.minor = 4;
  file.point_format = 6;
  EXPECT_EQ(read_content("a.las", file.bytes()).header.count, 3U);
}

TEST(LasReader, TakesTheLegacyCountWhereTheLongOneIsZero) {
  LasFile file;
  file.minor = 4;
  std::string bytes = file.bytes();
  put(bytes, 247, std::uint64_t{0});
  EXPECT_EQ(read_content("a.las", bytes).points.size(), 2U);
}

TEST(LasReader, LeavesOutWhatFollowsThePointsAndSaysSo) {
  const LasFile file;
  const auto notices = [](const std::string& bytes) {
    const AllPoints all = read_content("a.las", bytes);
    EXPECT_EQ(all.points.size(), 2U);
    return all.header.notices;
  };
  EXPECT_THAT(notices(file.bytes()), IsEmpty());
  EXPECT_THAT(notices(file.bytes() + std::string(file.record_length() - 1, 'E')), IsEmpty());
  EXPECT_THAT(notices(file.bytes() + std::string(1000, 'E')),
              ElementsAre(fmt::format(
                  "the header counts 3 points, but 1000 bytes follow them, room for {} more, which "
                  "are not read; if they are points, correct the count in the header (4 bytes from "
                  "byte 107 on), or salvage them",
                  1000 / file.record_length())));
}

TEST(LasReader, TakesZerosBehindThePointsForPadding) {
  const std::string padded = LasFile().bytes() + std::string(4096, '\0');
  EXPECT_THAT(read_content("a.las", padded).header.notices, IsEmpty());
  EXPECT_THAT(read_content("a.las", padded + "E").header.notices,
              ElementsAre(HasSubstr("4097 bytes follow them")));
}

TEST(LasReader, SaysAtTheEndOfAPipeThatMoreFollowsThePoints) {
  LasFile file;
  file.records = std::vector<LasFile::Record>(70000, {1, 2, 3});
  const auto notices = [](const std::string& bytes) {
    FaultyFileSystem pipe;
    pipe.seekable = false;
    pipe.files["a.las"] = bytes;
    return read_all_points(pipe, "a.las").notices;
  };
  EXPECT_THAT(notices(file.bytes()), IsEmpty());
  EXPECT_THAT(notices(file.bytes() + std::string(file.record_length() - 1, 'E')), IsEmpty());
  EXPECT_THAT(notices(file.bytes() + std::string(4096, '\0')), IsEmpty());
  for (const std::uint32_t told : {0, 65536, 69999}) {
    std::string bytes = file.bytes();
    put(bytes, 107, told);
    EXPECT_THAT(notices(bytes),
                ElementsAre(HasSubstr(
                    fmt::format("the header counts {} points, but more bytes follow them", told))));
  }
  file.minor = 4;
  file.point_format = 6;
  std::string bytes = file.bytes();
  put(bytes, 235, std::uint64_t{bytes.size()});
  put(bytes, 243, std::uint32_t{1});
  EXPECT_THAT(notices(bytes + std::string(1000, 'E')), IsEmpty());
}

TEST(LasReader, SaysWhatFollowsAHeaderThatCountsNoPoints) {
  std::string bytes = LasFile().bytes();
  put(bytes, 107, std::uint32_t{0});
  const AllPoints all = read_content("a.las", bytes);
  EXPECT_EQ(all.points.size(), 0U);
  EXPECT_THAT(all.header.notices, ElementsAre(HasSubstr("the header counts 0 points, but")));
}

constexpr const char* kWkt = "LOCAL_CS[\"here\"]";

/// Notices of a file that has whole points all the same, by name and on a pipe.
std::vector<std::string> notices_with_points(const std::string& bytes) {
  const AllPoints all = read_content("a.las", bytes);
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{1, 2, 3}, LatticePoint{7, -8, 9}));
  FaultyFileSystem pipe;
  pipe.seekable = false;
  pipe.files["a.las"] = bytes;
  EXPECT_EQ(read_all_points(pipe, "a.las").points, all.points);
  return all.header.notices;
}

TEST(LasReader, ReadsWholePointsThoughTheHeaderCountsRecordsThatAreNotThere) {
  LasFile file;
  const auto with_count = [&](std::uint32_t count) {
    std::string bytes = file.bytes();
    put(bytes, 100, count);
    return notices_with_points(bytes);
  };
  EXPECT_THAT(with_count(0xffffffff),
              ElementsAre(HasSubstr("counts 4294967295 variable length records, but none lies")));
  file.vlrs = {{"LASF_Projection", 2112, kWkt}, {"somebody", 1, std::string(60, 'c')}};
  EXPECT_THAT(with_count(2), IsEmpty());
  EXPECT_THAT(with_count(3), ElementsAre(HasSubstr("3 variable length records, but only 2 lie")));
}

TEST(LasReader, TakesRecordsUpToTheFirstThatDoesNotEndBeforeThePoints) {
  LasFile file;
  file.vlrs = {{"LASF_Projection", 2112, kWkt}, {"somebody", 1, "content"}};
  std::string bytes = file.bytes();
  put(bytes, 227 + 54 + file.vlrs[0].content.size() + 20, std::uint16_t{8});
  EXPECT_THAT(notices_with_points(bytes), ElementsAre(HasSubstr("records, but only 1 lies")));
  EXPECT_EQ(read_content("a.las", bytes).header.crs, kWkt);
}

TEST(LasReader, ReadsWholePointsThoughExtendedRecordsAreMissing) {
  LasFile file;
  file.minor = 4;
  file.point_format = 6;
  const std::string points = file.bytes();
  const auto with_records = [&](std::uint64_t start, std::uint32_t count, std::uint64_t length) {
    std::string bytes = points + std::string(100, '\0');
    put(bytes, 235, start);
    put(bytes, 243, count);
    put(bytes, points.size() + 20, length);
    return notices_with_points(bytes);
  };
  EXPECT_THAT(with_records(points.size(), 1, 40), IsEmpty());
  const auto missing = ElementsAre(HasSubstr("extended variable length record"));
  EXPECT_THAT(with_records(points.size(), 1, 41), missing);
  EXPECT_THAT(with_records(points.size(), 2, 40), missing);
  EXPECT_THAT(with_records(points.size(), 0xffffffff, 0), missing);
  EXPECT_THAT(with_records(points.size() + 1000, 1, 0), Contains(HasSubstr("extended variable")));
  EXPECT_THAT(with_records(~std::uint64_t{0}, 1, 0), Contains(HasSubstr("extended variable")));
}

TEST(LasReader, ExtendedRecordsBehindThePointsAreNoPoints) {
  LasFile file;
  file.minor = 4;
  file.point_format = 6;
  std::string bytes = file.bytes();
  put(bytes, 235, std::uint64_t{bytes.size()});
  put(bytes, 243, std::uint32_t{1});
  EXPECT_THAT(read_content("a.las", bytes + std::string(1000, '\0')).header.notices, IsEmpty());
}

TEST(LasReader, ReadsSeveralBlocks) {
  LasFile file;
  file.records.clear();
  for (int i = 0; i < 150000; ++i) file.records.push_back({i, 2 * i, -i, i % 3 == 0});
  const AllPoints all = read_content("a.las", file.bytes());
  ASSERT_EQ(all.points.size(), 100000U);
  EXPECT_EQ(all.withheld, 50000U);
  EXPECT_EQ(all.index[99999], 149999U);
  EXPECT_EQ(all.points[99999], (LatticePoint{149999, 299998, -149999}));
}

/// Three blocks of a file that is read when they are decoded, and the last of these first.
TEST(LasReader, ReadsBlocksWhereTheyAreDecoded) {
  LasFile file;
  file.records.clear();
  for (int i = 0; i < 150000; ++i) file.records.push_back({i, 2 * i, -i});
  FaultyFileSystem files;
  files.read_anywhere = true;
  files.files["a.las"] = file.bytes();
  const auto reader = open_point_reader(files, "a.las", {});
  const int reads = files.count(Call::kRead);
  std::array<RawPoints, 3> blocks;
  for (RawPoints& raw : blocks) {
    ASSERT_TRUE(reader->fetch(raw));
    EXPECT_TRUE(raw.unread);
  }
  RawPoints after;
  EXPECT_FALSE(reader->fetch(after));
  EXPECT_EQ(files.count(Call::kRead), reads);
  int next = 150000;
  for (std::size_t b = blocks.size(); b-- > 0;) {
    PointBlock block;
    reader->decode(blocks[b], block);
    EXPECT_FALSE(blocks[b].unread);
    next -= static_cast<int>(block.points.size());
    ASSERT_EQ(block.index.front(), static_cast<std::uint64_t>(next));
    ASSERT_EQ(block.points.front(), (LatticePoint{1.0 * next, 2.0 * next, -1.0 * next}));
  }
  EXPECT_EQ(next, 0);
}

TEST(LasReader, TellsWhereAFileEndsThatIsReadWhereItIsDecoded) {
  LasFile file;
  file.records.assign(150000, {1, 1, 1});
  const std::string bytes = file.bytes();
  FaultyFileSystem files;
  files.read_anywhere = true;
  files.files["a.las"] = bytes;
  const auto reader = open_point_reader(files, "a.las", {});
  RawPoints raw;
  ASSERT_TRUE(reader->fetch(raw));
  ASSERT_TRUE(reader->fetch(raw));
  const std::size_t record = (bytes.size() - raw.offset) / (150000 - 65536);
  files.reads_end_at = raw.offset + 10 * record + 3;
  PointBlock block;
  try {
    reader->decode(raw, block);
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_EQ(error.facts().place.number, files.reads_end_at);
    EXPECT_NE(std::string(error.what()).find("within point 65546 of 150000"), std::string::npos)
        << error.what();
  }
}

TEST(LasReader, PassesOverBlocksThatAreWithheldAltogether) {
  LasFile file;
  file.records.assign(70000, {1, 1, 1, true});
  file.records.push_back({2, 2, 2});
  const AllPoints all = read_content("a.las", file.bytes());
  EXPECT_THAT(all.points, ElementsAre(LatticePoint{2, 2, 2}));
  EXPECT_THAT(all.index, ElementsAre(70000));
}

TEST(LasReader, ReadsAPipe) {
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = LasFile().bytes();
  const AllPoints all = read_all_points(files, "-");
  EXPECT_EQ(all.header.format, "las");
  EXPECT_EQ(all.points.size(), 2U);
}

TEST(LasReader, TellsHowFarItIs) {
  LasFile file;
  file.records.assign(100000, {1, 1, 1});
  FaultyFileSystem files;
  files.files["a.las"] = file.bytes();
  const auto reader = open_point_reader(files, "a.las", {});
  EXPECT_EQ(reader->fraction_read(), 0.0);
  PointBlock block;
  reader->read(block);
  EXPECT_NEAR(*reader->fraction_read(), 0.655, 0.001);
  reader->read(block);
  EXPECT_EQ(reader->fraction_read(), 1.0);
}

TEST(LasReader, HoldsNoPoints) {
  LasFile file;
  file.records.clear();
  EXPECT_TRUE(read_content("a.las", file.bytes()).points.empty());
}

TEST(LasReader, LeavesOutBoundsThatAreNone) {
  std::string bytes = LasFile().bytes();
  put(bytes, 179, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(read_content("a.las", bytes).header.extent);
  put(bytes, 179, 9.0);  // the largest x is below the least
  EXPECT_FALSE(read_content("a.las", bytes).header.extent);
}

std::string geotiff_keys(const std::vector<std::array<std::uint16_t, 4>>& keys) {
  std::string content =
      bytes_of(std::array<std::uint16_t, 4>{1, 1, 0, static_cast<std::uint16_t>(keys.size())});
  for (const auto& key : keys) content += bytes_of(key);
  return content;
}

std::string crs_of(std::vector<LasFile::Vlr> vlrs) {
  LasFile file;
  file.vlrs = std::move(vlrs);
  return read_content("a.las", file.bytes()).header.crs;
}

TEST(LasCoordinateSystem, WktRecord) {
  EXPECT_EQ(crs_of({{"LASF_Projection", 2112, std::string("PROJCS[\n\"a\"]\0\0", 14)}}),
            "PROJCS[ \"a\"]");
}

TEST(LasCoordinateSystem, ProjectedGeotiffCodeBeforeGeographic) {
  EXPECT_EQ(crs_of({{"LASF_Projection", 34735,
                     geotiff_keys({{1024, 0, 1, 1}, {2048, 0, 1, 4326}, {3072, 0, 1, 25832}})}}),
            "EPSG:25832");
}

TEST(LasCoordinateSystem, GeographicGeotiffCode) {
  EXPECT_EQ(crs_of({{"LASF_Projection", 34735, geotiff_keys({{2048, 0, 1, 4326}})}}), "EPSG:4326");
}

TEST(LasCoordinateSystem, UserDefinedGeotiffCodeIsNone) {
  EXPECT_EQ(crs_of({{"LASF_Projection", 34735, geotiff_keys({{3072, 0, 1, 32767}})}}), "");
}

TEST(LasCoordinateSystem, WktBeforeGeotiff) {
  EXPECT_EQ(crs_of({{"LASF_Projection", 2112, "GEOGCS[]"},
                    {"LASF_Projection", 34735, geotiff_keys({{2048, 0, 1, 4326}})}}),
            "GEOGCS[]");
}

TEST(LasCoordinateSystem, RecordsOfOthersAreNone) {
  EXPECT_EQ(crs_of({{"somebody", 2112, "GEOGCS[]"}}), "");
}

TEST(LasCoordinateSystem, TruncatedGeotiffKeys) {
  EXPECT_EQ(crs_of({{"LASF_Projection", 34735, geotiff_keys({{2048, 0, 1, 4326}}).substr(0, 13)}}),
            "");
}

}  // namespace
}  // namespace spillway::test

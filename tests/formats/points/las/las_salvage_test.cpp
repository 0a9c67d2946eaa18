// What is read of LAS files that end early, or hold more than their header counts, when they are to
// be salvaged.

#include <fmt/format.h>

#include "tests/formats/points/las/las_file.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t kPoints = 140000;

PointReaderOptions salvage() {
  PointReaderOptions options;
  options.salvage = true;
  return options;
}

LasFile many_points() {
  LasFile file;
  file.records.clear();
  for (int i = 0; i < static_cast<int>(kPoints); ++i) file.records.push_back({i, 2 * i, -i});
  return file;
}

/// The file as it is read when it has only its first bytes.
AllPoints read_cut(std::string bytes, std::size_t size, bool seekable, bool anywhere = false) {
  FaultyFileSystem files;
  files.seekable = seekable;
  files.read_anywhere = anywhere;
  bytes.resize(size);
  files.files["a.las"] = std::move(bytes);
  return read_all_points(files, "a.las", salvage());
}

TEST(LasSalvage, AFileThatIsCutOffGivesTheRecordsThatAreWhole) {
  const LasFile file = many_points();
  const std::string bytes = file.bytes();
  for (const std::size_t whole :
       {std::size_t{0}, std::size_t{1}, std::size_t{65536}, kPoints - 1}) {
    const std::size_t size = file.offset_to_points() + whole * 20 + 19;
    EXPECT_THAT(error_of_content("a.las", bytes.substr(0, size)), HasSubstr("get a complete copy"));
    for (const bool anywhere : {false, true}) {
      const AllPoints all = read_cut(bytes, size, true, anywhere);
      EXPECT_EQ(all.points.size(), whole);
      EXPECT_EQ(all.header.count, whole);
      EXPECT_EQ(all.header.lost, kPoints - whole);
      EXPECT_EQ(all.lost, 0U);
      EXPECT_THAT(all.header.notices,
                  ElementsAre(fmt::format("the file ends at byte {}, after {} of {} points: {} are "
                                          "lost",
                                          size, whole, kPoints, kPoints - whole)));
      if (whole > 0) {
        EXPECT_EQ(all.points.back()[1], 2.0 * static_cast<double>(whole - 1));
      }
    }
    const AllPoints pipe = read_cut(bytes, size, false);
    EXPECT_EQ(pipe.points.size(), whole);
    EXPECT_EQ(pipe.header.count, std::nullopt);
    EXPECT_EQ(pipe.lost, kPoints - whole);
    EXPECT_THAT(pipe.notices, ElementsAre(HasSubstr(fmt::format("{} are lost", kPoints - whole))));
  }
}

TEST(LasSalvage, AWholeFileIsReadAsEver) {
  const std::string bytes = many_points().bytes();
  for (const bool seekable : {true, false}) {
    const AllPoints all = read_cut(bytes, bytes.size(), seekable);
    EXPECT_EQ(all.points.size(), kPoints);
    EXPECT_EQ(all.lost + all.header.lost, 0U);
    EXPECT_THAT(all.notices, IsEmpty());
    EXPECT_THAT(all.header.notices, IsEmpty());
    EXPECT_EQ(all.index.back(), kPoints - 1);
  }
}

TEST(LasSalvage, PointsThatTheHeaderDoesNotCountAreReadWhereTheyAreWhole) {
  std::string bytes = many_points().bytes() + "rest";
  for (const std::uint32_t told : {0U, 1U, 65536U, 139999U}) {
    put(bytes, 107, told);
    for (const bool seekable : {true, false}) {
      const AllPoints all = read_cut(bytes, bytes.size(), seekable);
      EXPECT_EQ(all.points.size(), kPoints);
      EXPECT_EQ(all.index.back(), kPoints - 1);
      EXPECT_EQ(all.lost + all.header.lost, 0U);
      EXPECT_FALSE(seekable && all.header.extent) << "it may be of the counted points";
      EXPECT_THAT(seekable ? all.header.notices : all.notices,
                  ElementsAre(HasSubstr(fmt::format("the header counts {} points, but", told))));
    }
  }
}

TEST(LasSalvage, WhatLiesBehindThePointsStaysUnread) {
  LasFile file;
  file.minor = 4;
  file.point_format = 6;
  std::string bytes = file.bytes();
  put(bytes, 235, std::uint64_t{bytes.size()});
  put(bytes, 243, std::uint32_t{1});
  bytes += std::string(1000, '\7');
  for (const std::string& content : {bytes, LasFile().bytes() + std::string(1000, '\0')}) {
    for (const bool seekable : {true, false}) {
      EXPECT_EQ(read_cut(content, content.size(), seekable).points.size(), 2U);
    }
  }
}

TEST(LasSalvage, AHeaderThatIsNotWholeStaysAnError) {
  const std::string bytes = LasFile().bytes();
  EXPECT_THAT(error_of_content("a.las", bytes.substr(0, 200), salvage()),
              HasSubstr("within the header"));
}

}  // namespace
}  // namespace spillway::test

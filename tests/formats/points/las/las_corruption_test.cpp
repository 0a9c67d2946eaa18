#include <limits>

#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/las/las_file.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The message for a file of which one field was overwritten.
template <typename T>
std::string error_with(std::size_t at, T value, const LasFile& file = {}) {
  std::string bytes = file.bytes();
  put(bytes, at, value);
  return error_of_content("a.las", bytes);
}

/// The same, with the file coming through a pipe, whose size is unknown.
std::string error_on_pipe(const std::string& bytes) {
  FaultyFileSystem files;
  files.seekable = false;
  files.files["a.las"] = bytes;
  return error_of([&] { read_all_points(files, "a.las"); });
}

LasFile version_4() {
  LasFile file;
  file.minor = 4;
  file.point_format = 6;
  return file;
}

TEST(LasCorruption, Empty) {
  EXPECT_THAT(error_of_content("a.las", ""), HasSubstr("a.las: the input is empty"));
}

TEST(LasCorruption, WrongSignature) {
  EXPECT_THAT(error_with(0, 'l'), HasSubstr("a.las: this is not a LAS file"));
}

TEST(LasCorruption, TruncatedHeader) {
  EXPECT_THAT(error_of_content("a.las", LasFile().bytes().substr(0, 226)),
              HasSubstr("ends at byte 226, within the header of 227"));
  EXPECT_THAT(error_of_content("a.las", version_4().bytes().substr(0, 300)),
              HasSubstr("ends at byte 300, within the header of 375"));
}

TEST(LasCorruption, UnknownVersion) {
  EXPECT_THAT(error_with(24, std::uint8_t{2}), HasSubstr("version 2.2"));
  EXPECT_THAT(error_with(25, std::uint8_t{6}), HasSubstr("version 1.6"));
}

TEST(LasCorruption, HeaderSizeTooSmall) {
  EXPECT_THAT(error_with(94, std::uint16_t{226}), HasSubstr("LAS 1.2 needs 227"));
  EXPECT_THAT(error_with(94, std::uint16_t{227}, version_4()), HasSubstr("LAS 1.4 needs 375"));
}

TEST(LasCorruption, HeaderSizeLargerThanFile) {
  EXPECT_THAT(error_with(94, std::uint16_t{65535}), HasSubstr("within the header of 65535"));
}

TEST(LasCorruption, OffsetToPointsWithinHeader) {
  EXPECT_THAT(error_with(96, std::uint32_t{226}), HasSubstr("points begin at byte 226, within"));
}

TEST(LasCorruption, OffsetToPointsBeyondFile) {
  EXPECT_THAT(error_with(96, std::uint32_t{0xffffffff}),
              AllOf(HasSubstr("begin at byte 4294967295"), HasSubstr("ends at byte 287")));
}

TEST(LasCorruption, OffsetToPointsBeyondPipe) {
  std::string bytes = LasFile().bytes();
  put(bytes, 96, std::uint32_t{100000});
  EXPECT_THAT(error_on_pipe(bytes), HasSubstr("ends at byte 287, before the points"));
}

TEST(LasCorruption, VlrCountTooLargeAndPointsTruncated) {
  std::string bytes = LasFile().bytes();
  put(bytes, 100, std::uint32_t{0xffffffff});
  bytes.pop_back();
  EXPECT_THAT(error_of_content("a.las", bytes),
              AllOf(HasSubstr("3 points of 20 bytes, but the file ends at byte 286, after 2"),
                    HasSubstr("4294967295 variable length records do not fit")));
  EXPECT_THAT(error_on_pipe(bytes), HasSubstr("ends at byte 286, within point 2 of 3"));
}

TEST(LasCorruption, VlrsTruncatedOnPipe) {
  LasFile file;
  file.vlrs = {{"somebody", 1, "content"}};
  EXPECT_THAT(error_on_pipe(file.bytes().substr(0, 250)),
              HasSubstr("ends at byte 250, before the points"));
}

TEST(LasCorruption, CompressedFlagWithoutLazRecord) {
  for (const std::uint8_t flag : {0x80, 0x40}) {
    EXPECT_THAT(error_with(104, flag), HasSubstr("there is no record that says how"));
  }
}

TEST(LasCorruption, CompressedBeforeLaz) {
  EXPECT_THAT(error_with(104, std::uint8_t{0xC0}), HasSubstr("in the way before LAZ"));
}

TEST(LasCorruption, UnknownPointFormat) {
  EXPECT_THAT(error_with(104, std::uint8_t{11}), HasSubstr("point format 11"));
}

TEST(LasCorruption, RecordLengthTooSmall) {
  EXPECT_THAT(error_with(105, std::uint16_t{19}),
              HasSubstr("records of 19 bytes, but format 0 needs 20"));
  EXPECT_THAT(error_with(105, std::uint16_t{0}), HasSubstr("records of 0 bytes"));
}

TEST(LasCorruption, CountLargerThanFile) {
  EXPECT_THAT(error_with(107, std::uint32_t{4}),
              HasSubstr("4 points of 20 bytes, but the file ends at byte 287, after 3 of them"));
}

TEST(LasCorruption, LongCountLargerThanAnyFile) {
  EXPECT_THAT(error_with(247, std::numeric_limits<std::uint64_t>::max(), version_4()),
              HasSubstr("18446744073709551615 points of 30 bytes"));
}

TEST(LasCorruption, CountsContradict) {
  LasFile file;
  file.minor = 4;
  EXPECT_THAT(error_with(247, std::uint64_t{2}, file), HasSubstr("two numbers of points, 3 and 2"));
}

TEST(LasCorruption, TruncatedPoints) {
  const std::string bytes = LasFile().bytes();
  EXPECT_THAT(error_of_content("a.las", bytes.substr(0, bytes.size() - 1)),
              HasSubstr("after 2 of them"));
}

TEST(LasCorruption, TruncatedPointsOnPipe) {
  const std::string bytes = LasFile().bytes();
  EXPECT_THAT(error_on_pipe(bytes.substr(0, bytes.size() - 1)),
              HasSubstr("ends at byte 286, within point 2 of 3"));
}

TEST(LasCorruption, EnormousCountOnPipeUsesNoMemory) {
  std::string bytes = version_4().bytes();
  put(bytes, 247, std::numeric_limits<std::uint64_t>::max());
  EXPECT_THAT(error_on_pipe(bytes), HasSubstr("within point 3 of 18446744073709551615"));
}

TEST(LasCorruption, ScaleIsNoPositiveNumber) {
  for (const double scale : {0.0, -0.01, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), 1e300}) {
    EXPECT_THAT(error_with(139, scale), HasSubstr("for y, but a scale is a positive number"));
  }
}

TEST(LasCorruption, OffsetIsNotFinite) {
  for (const double offset :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(error_with(171, offset), HasSubstr("for z"));
  }
}

TEST(LasCorruption, MessagesBeginWithTheFile) {
  EXPECT_THAT(error_with(105, std::uint16_t{0}), StartsWith("a.las: "));
}

}  // namespace
}  // namespace spillway::test

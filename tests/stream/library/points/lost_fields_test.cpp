// What another file does not keep of the inputs' points.

#include "stream/library/points/lost_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "formats/points/point_formats.h"

namespace spillway::detail {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;

PointHeader las(int point_format, std::size_t extra_bytes = 0) {
  PointHeader header;
  header.format = "las";
  header.point_format = point_format;
  header.extra_bytes = extra_bytes;
  return header;
}

std::vector<std::string> lost_in_las(const std::vector<PointHeader>& headers) {
  return lost_fields(headers, point_format_by_name("las"), true, true);
}

/// The point formats of the LAS 1.4 specification, R15, section 2.6.
TEST(LostFields, OfLasAreWhatItsRecordsHave) {
  const std::set<int> with_colour = {2, 3, 5, 7, 8, 10};
  const std::set<int> with_waveforms = {4, 5, 9, 10};
  for (int format = 0; format <= 10; ++format) {
    const std::vector<std::string> lost = lost_in_las({las(format)});
    const auto has = [&](const char* field) {
      return std::find(lost.begin(), lost.end(), field) != lost.end();
    };
    EXPECT_TRUE(has("intensity")) << format;
    EXPECT_EQ(has("GPS time"), format != 0 && format != 2) << format;
    EXPECT_EQ(has("colour"), with_colour.contains(format)) << format;
    EXPECT_EQ(has("near infrared"), format == 8 || format == 10) << format;
    EXPECT_EQ(has("waveforms"), with_waveforms.contains(format)) << format;
    EXPECT_EQ(has("scanner channel"), format >= 6) << format;
    EXPECT_FALSE(has("extra bytes"));
  }
  EXPECT_THAT(lost_in_las({las(0, 3)}), Contains("extra bytes"));
}

TEST(LostFields, AreClassesReturnsAndFlagsUnlessThoseAreKept) {
  const PointFormat& text = point_format_by_name("text");
  EXPECT_THAT(lost_fields({las(0)}, text, false, false),
              IsSupersetOf({"classes", "returns", "flags"}));
  const auto kept = lost_fields({las(0)}, point_format_by_name("las"), true, false);
  for (const char* const field : {"classes", "returns", "flags"}) {
    EXPECT_THAT(kept, Not(Contains(field)));
  }
}

TEST(LostFields, IsTheCoordinateSystemWhereTheFormatHoldsNone) {
  PointHeader text;
  text.format = "text";
  EXPECT_THAT(lost_fields({text}, point_format_by_name("npy"), false, true),
              ElementsAre("coordinate system"));
  EXPECT_THAT(lost_fields({text}, point_format_by_name("npy"), false, false), IsEmpty());
  EXPECT_THAT(lost_fields({text}, point_format_by_name("las"), false, true), IsEmpty());
}

TEST(LostFields, OfSeveralFilesAreNamedOnceEach) {
  const auto lost = lost_in_las({las(0), las(3), las(1), las(3)});
  std::vector<std::string> sorted = lost;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
  EXPECT_THAT(lost, IsSupersetOf({"intensity", "GPS time", "colour"}));
  EXPECT_THAT(lost_in_las({}), IsEmpty());
}

}  // namespace
}  // namespace spillway::detail

// What another file does not keep of the inputs' points.

#include "stream/library/points/lost_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "formats/points/las/records/las_fields.h"
#include "formats/points/las/records/las_metadata.h"
#include "formats/points/point_formats.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;

PointHeader las(int point_format) {
  PointHeader header;
  header.format = "las";
  header.point_format = point_format;
  header.attributes = las_layout(point_format, {});
  return header;
}

std::vector<std::string> lost_in(const std::string& format, const std::vector<PointHeader>& headers,
                                 const PointWriterOptions& written = {}) {
  std::vector<AttributeLayout> layouts;
  for (const PointHeader& header : headers) layouts.push_back(header.attributes);
  return lost_fields(joined(layouts), headers, point_format_by_name(format), written);
}

TEST(LostFields, AreTheAttributesThatAreNotWritten) {
  EXPECT_THAT(lost_in("npy", {las(1)}), IsSupersetOf({"intensity", "classification", "gps_time"}));
  PointWriterOptions written;
  written.attributes = las(1).attributes;
  EXPECT_THAT(lost_in("las", {las(1)}, written), IsEmpty());
  EXPECT_THAT(lost_in("las", {las(1), las(2)}, written), ElementsAre("red", "green", "blue"));
}

TEST(LostFields, IsTheCoordinateSystemWhereTheFormatHoldsNone) {
  PointHeader text;
  text.format = "text";
  PointWriterOptions written;
  EXPECT_THAT(lost_in("npy", {text}, written), IsEmpty());
  written.crs = "EPSG:25832";
  EXPECT_THAT(lost_in("npy", {text}, written), ElementsAre("coordinate system"));
  EXPECT_THAT(lost_in("las", {text}, written), IsEmpty());
}

TEST(LostFields, OfSeveralFilesAreNamedOnceEach) {
  std::vector<std::string> lost = lost_in("npy", {las(0), las(3), las(1), las(3)});
  std::ranges::sort(lost);
  EXPECT_EQ(std::ranges::adjacent_find(lost), lost.end());
  EXPECT_THAT(lost, IsSupersetOf({"intensity", "gps_time", "red"}));
  EXPECT_THAT(lost_in("npy", {}), IsEmpty());
}

TEST(LostFields, AreTheRecordsOfLasWhereTheOutputIsNoLasAndThoseThatWereLeftOut) {
  LasMetadata metadata;
  metadata.records = {{.user = "liblas", .id = 2112},
                      {.user = "LASF_Projection", .id = 2112},
                      {.user = "LASF_Spec", .id = 4}};
  metadata.left_out = {"waveforms"};
  PointHeader header;
  header.las_metadata = std::make_shared<LasMetadata>(metadata);
  EXPECT_THAT(lost_in("npy", {header}), ElementsAre("record 2112 of liblas"));
  PointWriterOptions written;
  written.las = header.las_metadata;
  EXPECT_THAT(lost_in("las", {header}, written), ElementsAre("waveforms"));
}

TEST(LostFields, AreWaveformsInCopc) {
  LasMetadata metadata;
  metadata.records = {{.user = "LASF_Spec", .id = 100},
                      {.user = "LASF_Spec", .id = 65535, .extended = true},
                      {.user = "mine", .id = 100}};
  PointHeader header = las(10);
  header.las_metadata = std::make_shared<LasMetadata>(metadata);
  PointWriterOptions written;
  written.attributes = header.attributes;
  written.las = header.las_metadata;
  EXPECT_THAT(lost_in("laz", {header}, written), IsEmpty());
  EXPECT_THAT(
      lost_in("copc", {header}, written),
      ElementsAre("wave_packet_descriptor", "wave_packet_offset", "wave_packet_size",
                  "wave_packet_location", "wave_packet_dx", "wave_packet_dy", "wave_packet_dz",
                  "record 100 of LASF_Spec", "record 65535 of LASF_Spec"));
}

}  // namespace
}  // namespace spillway::test

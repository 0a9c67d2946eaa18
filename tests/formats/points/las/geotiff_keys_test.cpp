// What GeoTIFF keys say of a coordinate system: only what is certain is one, and what is not has a
// reason.

#include "formats/points/las/geotiff_keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/formats/with_gdal.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

using Keys = std::vector<std::array<std::uint16_t, 4>>;

GeotiffKeys records_of(std::span<const std::byte> directory, const std::string& text = "") {
  return {.directory = {directory.begin(), directory.end()}, .text = text};
}

GeotiffCrs crs_of(const Keys& keys, const std::string& text = "") {
  std::vector<std::uint16_t> numbers = {1, 1, 0, static_cast<std::uint16_t>(keys.size())};
  for (const auto& key : keys) numbers.insert(numbers.end(), key.begin(), key.end());
  return read_geotiff_keys(records_of(std::as_bytes(std::span(numbers)), text));
}

/// The reason why there is no system.
std::string reason(const Keys& keys, const std::string& text = "") {
  const GeotiffCrs crs = crs_of(keys, text);
  EXPECT_EQ(crs.crs, "");
  return crs.note;
}

TEST(GeotiffKeys, NameASystemOfTheModelsKind) {
  if (!with_gdal()) GTEST_SKIP() << "GDAL knows what the codes are";
  EXPECT_EQ(crs_of({{1024, 0, 1, 1}, {2048, 0, 1, 4326}, {3072, 0, 1, 25832}}).crs, "EPSG:25832");
  EXPECT_EQ(crs_of({{1024, 0, 1, 1}, {3072, 0, 1, 5514}}).crs, "EPSG:5514");
  EXPECT_EQ(crs_of({{1024, 0, 1, 2}, {2048, 0, 1, 4326}}).crs, "EPSG:4326");
  EXPECT_EQ(crs_of({{1024, 0, 1, 2}, {2048, 0, 1, 7844}}).crs, "EPSG:7844");
  for (const std::uint16_t code : {4978, 4936, 4936, 7789}) {
    const GeotiffCrs crs = crs_of({{1024, 0, 1, 3}, {2048, 0, 1, code}});
    EXPECT_EQ(crs.crs, "EPSG:" + std::to_string(code));
    EXPECT_EQ(crs.note, "");
  }
}

TEST(GeotiffKeys, GeocentricCoordinatesAreInNoGeographicSystem) {
  EXPECT_THAT(reason({{1025, 0, 1, 2}, {1024, 0, 1, 3}, {2048, 0, 1, 4326}}),
              HasSubstr("geocentric, but EPSG:4326 is a geographic system"));
  EXPECT_THAT(reason({{1024, 0, 1, 3}, {2048, 0, 1, 4979}}), HasSubstr("EPSG:4979"));
  EXPECT_THAT(reason({{1024, 0, 1, 3}}), HasSubstr("without a code"));
  EXPECT_THAT(reason({{1024, 0, 1, 3}, {2048, 0, 1, 32767}}), HasSubstr("geocentric"));
  EXPECT_THAT(reason({{1024, 0, 1, 3}, {2048, 0, 1, 4978}, {3072, 0, 1, 32633}}),
              HasSubstr("EPSG:32633"));
}

TEST(GeotiffKeys, ProjectedCoordinatesAreNotInTheSystemBelowTheProjection) {
  EXPECT_THAT(reason({{1024, 0, 1, 1}, {2048, 0, 1, 4269}}), HasSubstr("without a code"));
  EXPECT_THAT(reason({{1024, 0, 1, 1},
                      {1026, 34737, 6, 8},
                      {2048, 0, 1, 4269},
                      {3072, 0, 1, 32767},
                      {3073, 34737, 8, 0}},
                     "My grid|Whole|"),
              HasSubstr("(\"My grid\")"));
  EXPECT_THAT(reason({{1024, 0, 1, 1}, {1026, 34737, 6, 8}, {3072, 0, 1, 32767}}, "My grid|Whole|"),
              HasSubstr("(\"Whole\")"));
  EXPECT_THAT(reason({{1024, 0, 1, 1}, {3072, 0, 1, 4326}}),
              HasSubstr("projected, but EPSG:4326 is a geographic system"));
}

TEST(GeotiffKeys, GeographicModelWithAProjectedSystemIsNone) {
  EXPECT_THAT(reason({{1024, 0, 1, 2}, {2048, 0, 1, 4326}, {3072, 0, 1, 25832}}),
              HasSubstr("geographic, and name the projected system EPSG:25832"));
  EXPECT_THAT(reason({{1024, 0, 1, 2}, {2048, 0, 1, 4978}}), HasSubstr("a geocentric system"));
}

TEST(GeotiffKeys, WithoutAModelTheOnlySystemNamedIsIt) {
  EXPECT_EQ(crs_of({{3072, 0, 1, 2154}}).crs, "EPSG:2154");
  EXPECT_EQ(crs_of({{2048, 0, 1, 4326}}).crs, "EPSG:4326");
  for (const std::uint16_t model : {0, 32767}) {
    EXPECT_EQ(crs_of({{1024, 0, 1, model}, {2048, 0, 1, 4326}, {3072, 0, 1, 2154}}).crs,
              "EPSG:2154");
    EXPECT_THAT(reason({{1024, 0, 1, model}, {2048, 0, 1, 4326}}), HasSubstr("EPSG:4326"));
  }
  EXPECT_THAT(reason({{2048, 0, 1, 4326}, {3072, 0, 1, 32767}}), HasSubstr("EPSG:4326"));
  EXPECT_THAT(reason({{2048, 0, 1, 4326}, {3075, 0, 1, 8}}), HasSubstr("EPSG:4326"));
  EXPECT_THAT(reason({{3072, 0, 1, 32767}}), HasSubstr("of their own"));
  EXPECT_EQ(reason({}), "");
  EXPECT_EQ(reason({{1025, 0, 1, 1}}), "");
  EXPECT_THAT(reason({{1024, 0, 1, 7}, {2048, 0, 1, 4326}}), HasSubstr("7, that does not exist"));
}

TEST(GeotiffKeys, LengthsInAnotherUnitAreAnotherSystem) {
  if (!with_gdal()) GTEST_SKIP() << "GDAL knows what the codes are";
  EXPECT_EQ(crs_of({{1024, 0, 1, 1}, {3072, 0, 1, 2903}, {3076, 0, 1, 9003}}).crs, "EPSG:2903");
  EXPECT_EQ(crs_of({{1024, 0, 1, 1}, {3072, 0, 1, 26995}, {3076, 0, 1, 9001}}).crs, "EPSG:26995");
  for (const std::uint16_t unit : {9002, 9003, 32767}) {
    EXPECT_THAT(reason({{1024, 0, 1, 1}, {3072, 0, 1, 26995}, {3076, 0, 1, unit}}),
                HasSubstr("EPSG:26995, but lengths in another unit"));
  }
  EXPECT_THAT(reason({{1024, 0, 1, 1}, {3072, 0, 1, 2903}, {3076, 0, 1, 9002}}),
              HasSubstr("another unit"));
}

TEST(GeotiffKeys, LengthsInMetresAreNotThoseOfASystemInFeet) {
  if (!with_gdal()) GTEST_SKIP() << "GDAL knows what the codes are";
  const GeotiffCrs crs = crs_of({{1024, 0, 1, 1}, {3072, 0, 1, 2903}, {3076, 0, 1, 9001}});
  EXPECT_EQ(crs.crs, "");
  EXPECT_THAT(crs.note, HasSubstr("EPSG:2903, but lengths in another unit (EPSG:9001)"));
  EXPECT_EQ(crs_of({{1024, 0, 1, 1}, {3072, 0, 1, 2903}, {3076, 0, 1, 0}}).crs, "EPSG:2903");
  EXPECT_EQ(crs_of({{1024, 0, 1, 1}, {3072, 0, 1, 2903}}).crs, "EPSG:2903");
}

TEST(GeotiffKeys, MetricSystemsAreThoseOfGdal) {
  for (int code = 2000; code < 32767; ++code) {
    const std::string name = "EPSG:" + std::to_string(code);
    if (gdal().crs_kind(name) != CrsKind::kProjected) continue;
    const bool metric = gdal().crs_unit(name) == 1;
    const auto number = static_cast<std::uint16_t>(code);
    EXPECT_EQ(crs_of({{1024, 0, 1, 1}, {3072, 0, 1, number}, {3076, 0, 1, 9001}}).crs.empty(),
              !metric)
        << code;
  }
}

TEST(GeotiffKeys, CodesThatEpsgDoesNotHaveAreNoSystem) {
  if (!with_gdal()) GTEST_SKIP() << "GDAL knows what the codes are";
  EXPECT_THAT(reason({{1024, 0, 1, 1}, {3072, 0, 1, 1234}}),
              HasSubstr("projected, but EPSG:1234 is no system that GDAL knows"));
  EXPECT_THAT(reason({{1024, 0, 1, 2}, {2048, 0, 1, 1234}}),
              HasSubstr("geographic, but EPSG:1234 is no system that GDAL knows"));
  // In a range of projected systems, where GDAL is asked for the unit only.
  EXPECT_THAT(reason({{1024, 0, 1, 1}, {3072, 0, 1, 31000}, {3076, 0, 1, 9001}}),
              HasSubstr("EPSG:31000 is no system that GDAL knows"));
}

TEST(GeotiffKeys, HeightsAreNotedAndDoNotCount) {
  const GeotiffCrs crs = crs_of({{1024, 0, 1, 1}, {3072, 0, 1, 25832}, {4096, 0, 1, 5783}});
  EXPECT_EQ(crs.crs, "EPSG:25832");
  EXPECT_THAT(crs.note, HasSubstr("heights (EPSG:5783)"));
  EXPECT_THAT(reason({{4096, 0, 1, 5783}}), HasSubstr("heights"));
}

/// A transverse Mercator of its own: longitude 9, scale 0.9996, false easting 500000.
GeotiffKeys own_projection(std::uint16_t heights) {
  const Keys keys = {{1024, 0, 1, 1},     {2048, 0, 1, 4258},  {3072, 0, 1, 32767},
                     {3074, 0, 1, 32767}, {3075, 0, 1, 1},     {3076, 0, 1, 9001},
                     {3080, 34736, 1, 0}, {3081, 34736, 1, 1}, {3082, 34736, 1, 3},
                     {3083, 34736, 1, 4}, {3092, 34736, 1, 2}, {4096, 0, 1, heights}};
  std::vector<std::uint16_t> directory = {1, 1, 0, static_cast<std::uint16_t>(keys.size())};
  for (const auto& key : keys) directory.insert(directory.end(), key.begin(), key.end());
  GeotiffKeys records = records_of(std::as_bytes(std::span(directory)));
  const std::array<double, 5> numbers = {9, 0, 0.9996, 500000, 0};
  const auto bytes = std::as_bytes(std::span(numbers));
  records.numbers.assign(bytes.begin(), bytes.end());
  return records;
}

TEST(GeotiffKeys, ProjectionsOfTheirOwnAreReadByGdal) {
  if (!with_gdal()) GTEST_SKIP() << "GDAL reads parameters";
  const GeotiffCrs crs = read_geotiff_keys(own_projection(0));
  EXPECT_TRUE(gdal().same_crs(crs.crs, "EPSG:25832")) << crs.crs;
  EXPECT_EQ(crs.note, "");
  const GeotiffCrs with_heights = read_geotiff_keys(own_projection(5783));
  EXPECT_TRUE(gdal().same_crs(with_heights.crs, "EPSG:25832+5783")) << with_heights.crs;
  EXPECT_EQ(with_heights.note, "");
}

TEST(GeotiffKeys, OfDamagedProjectionsAreNone) {
  if (!with_gdal()) GTEST_SKIP() << "GDAL reads parameters";
  GeotiffKeys records = own_projection(0);
  records.numbers.resize(17);
  const GeotiffCrs crs = read_geotiff_keys(records);
  EXPECT_TRUE(crs.crs.empty() || gdal().crs_kind(crs.crs) == CrsKind::kProjected);
  for (std::size_t i = 8; i < records.directory.size(); ++i) {
    GeotiffKeys damaged = own_projection(0);
    damaged.directory[i] ^= std::byte{0xff};
    const GeotiffCrs read = read_geotiff_keys(damaged);
    EXPECT_TRUE(read.crs.empty() || gdal().crs_kind(read.crs) != CrsKind::kUnknown) << i;
  }
}

TEST(GeotiffKeys, HeightsGoAlongWhereGdalIsAsked) {
  if (!with_gdal()) GTEST_SKIP() << "GDAL knows systems of heights";
  const std::vector<std::uint16_t> numbers = {1,    1, 0, 3,     1024, 0, 1, 1,
                                              3072, 0, 1, 26918, 4096, 0, 1, 6360};
  const GeotiffKeys records = records_of(std::as_bytes(std::span(numbers)));
  EXPECT_TRUE(read_geotiff_keys(records).has_more);
  const std::string whole = whole_geotiff_crs("EPSG:26918", records);
  EXPECT_TRUE(gdal().same_crs(whole, "EPSG:26918+6360"));
  EXPECT_THAT(whole, HasSubstr("NAVD88 height (ftUS)"));
}

TEST(GeotiffKeys, CutShortAreNone) {
  const std::array<std::uint16_t, 8> keys = {1, 1, 0, 2, 3072, 0, 1, 25832};
  const GeotiffCrs crs = read_geotiff_keys(records_of(std::as_bytes(std::span(keys))));
  EXPECT_EQ(crs.crs, "");
  EXPECT_THAT(crs.note, HasSubstr("cut short"));
  EXPECT_THAT(read_geotiff_keys({}).note, HasSubstr("cut short"));
}

TEST(GeotiffKeys, WrittenOnesAreReadAsTheSameSystem) {
  const std::array systems = {std::pair{std::uint16_t{25832}, CrsKind::kProjected},
                              std::pair{std::uint16_t{7844}, CrsKind::kGeographic},
                              std::pair{std::uint16_t{4978}, CrsKind::kGeocentric}};
  for (const auto& [code, kind] : systems) {
    const GeotiffCrs crs = read_geotiff_keys(records_of(geotiff_keys_of(code, kind)));
    EXPECT_EQ(crs.crs, "EPSG:" + std::to_string(code));
    EXPECT_EQ(crs.note, "");
  }
}

TEST(GeotiffKeys, KindsOfCodesThatAreNotAskedForAreThoseOfGdal) {
  for (int code = 2000; code < 32767; code += code < 8000 ? 1 : 7) {
    const CrsKind kind = gdal().crs_kind("EPSG:" + std::to_string(code));
    if (kind == CrsKind::kUnknown) continue;
    EXPECT_EQ(kind_of_epsg(static_cast<std::uint16_t>(code)), kind) << code;
  }
  EXPECT_EQ(kind_of_epsg(7405), CrsKind::kOther);
  EXPECT_EQ(kind_of_epsg(1), CrsKind::kUnknown);
}

}  // namespace
}  // namespace spillway::test

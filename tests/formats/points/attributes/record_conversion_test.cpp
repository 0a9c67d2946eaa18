// Numbers of attributes on their way from records of one kind to those of another.

#include "formats/points/attributes/record_conversion.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "formats/points/attributes/attribute_names.h"

namespace spillway::test {
namespace {

using enum NumberType;

/// The one number of a record of `from` as that of a record of `to`; nothing if it does not fit.
std::optional<double> converted(const Attribute& from, const Attribute& to, double number) {
  const AttributeLayout source({from});
  const AttributeLayout target({to});
  std::vector<std::byte> in(source.record_size());
  std::vector<std::byte> out(target.record_size());
  EXPECT_TRUE(store_number(from.type, in.data(), number));
  const RecordConversion conversion(source.fields(), target.fields());
  if (conversion.convert(in.data(), in.size(), out.data(), out.size(), 1)) return std::nullopt;
  return load_number(to.type, out.data());
}

TEST(RecordConversion, KeepsWholeNumbersOfAnyTypeAndRefusesThoseThatDoNotFit) {
  const std::vector<NumberType> types = {kInt8,   kUint8, kInt16,  kUint16,  kInt32,
                                         kUint32, kInt64, kUint64, kFloat32, kFloat64};
  for (const NumberType from : types) {
    for (const NumberType to : types) {
      EXPECT_EQ(converted({.name = "a", .type = from}, {.name = "a", .type = to}, 100), 100);
    }
  }
  EXPECT_EQ(converted({"a", kInt16}, {"a", kUint8}, -1), std::nullopt);
  EXPECT_EQ(converted({"a", kInt16}, {"a", kUint8}, 256), std::nullopt);
  EXPECT_EQ(converted({"a", kFloat64}, {"a", kUint16}, 0.5), std::nullopt);
  EXPECT_EQ(converted({"a", kFloat64}, {"a", kInt32}, std::numeric_limits<double>::quiet_NaN()),
            std::nullopt);
  EXPECT_EQ(converted({"a", kFloat64}, {"a", kInt64}, 0x1p63), std::nullopt);
}

TEST(RecordConversion, KeepsIntegersOf64BitsExactly) {
  const std::uint64_t large = std::numeric_limits<std::uint64_t>::max() / 2;
  const AttributeLayout from({{.name = "a", .type = kUint64}});
  const AttributeLayout to({{.name = "a", .type = kInt64}});
  std::int64_t out = 0;
  const RecordConversion conversion(from.fields(), to.fields());
  EXPECT_FALSE(conversion.convert(std::as_bytes(std::span(&large, 1)).data(), 8,
                                  std::as_writable_bytes(std::span(&out, 1)).data(), 8, 1));
  EXPECT_EQ(out, std::numeric_limits<std::int64_t>::max());
}

TEST(RecordConversion, TurnsScalesAndRoundsToTheNearestStep) {
  const Attribute degrees{.name = "scan_angle", .type = kInt8};
  const Attribute fine{.name = "scan_angle", .type = kInt16, .scale = 0.006};
  for (int angle = -90; angle <= 90; ++angle) {
    const auto there = converted(degrees, fine, angle);
    ASSERT_TRUE(there);
    EXPECT_NEAR(*there * 0.006, angle, 0.0031);
    EXPECT_EQ(converted(fine, degrees, *there), angle);
  }
}

TEST(RecordConversion, PacksBitsBesideOthersAndNamesWhatDoesNotFit) {
  const AttributeLayout from({{.name = "a", .type = kUint8}, {.name = "b", .type = kUint8}});
  const std::vector<AttributeField> to = {
      {.attribute = {.name = "a", .type = kUint8}, .packed = true, .bit = 0, .bits = 3},
      {.attribute = {.name = "b", .type = kUint8}, .packed = true, .bit = 3, .bits = 5}};
  const RecordConversion packing(from.fields(), to);
  const RecordConversion unpacking(to, from.fields());
  for (unsigned a = 0; a < 9; ++a) {
    for (const unsigned b : {0U, 1U, 31U, 32U}) {
      const std::vector<std::byte> record = {std::byte(a), std::byte(b)};
      std::byte packed{};
      const auto misfit = packing.convert(record.data(), 2, &packed, 1, 1);
      ASSERT_EQ(misfit.has_value(), a > 7 || b > 31);
      if (misfit) {
        EXPECT_EQ(range_text(misfit->to), a > 7 ? "0 to 7" : "0 to 31");
        continue;
      }
      EXPECT_EQ(packed, std::byte(a | b << 3U));
      std::vector<std::byte> back(2);
      EXPECT_FALSE(unpacking.convert(&packed, 1, back.data(), 2, 1));
      EXPECT_EQ(back, record);
    }
  }
}

TEST(AttributeLayout, OfTwoIntegersIsTheLeastThatHoldsBoth) {
  const auto common = [](NumberType a, NumberType b) {
    const std::vector<AttributeLayout> layouts = {AttributeLayout({{"n", a}}),
                                                  AttributeLayout({{"n", b}})};
    return joined(layouts).find("n")->attribute.type;
  };
  EXPECT_EQ(common(kInt32, kInt64), kInt64);
  EXPECT_EQ(common(kUint8, kUint16), kUint16);
  EXPECT_EQ(common(kUint16, kInt8), kInt32);
  EXPECT_EQ(common(kUint8, kInt16), kInt16);
  EXPECT_EQ(common(kInt64, kUint32), kInt64);
  EXPECT_EQ(common(kInt8, kUint64), kFloat64);
  EXPECT_EQ(common(kFloat32, kUint8), kFloat64);
}

TEST(AttributeLayout, OfSeveralSourcesHasTheAttributesOfAllAndHoldsTheNumbersOfEach) {
  const AttributeLayout one({{.name = "intensity", .type = kUint16}, {"angle", kInt8}});
  const AttributeLayout two({{"angle", kInt16, 1, 0.006}, {"time", kFloat64}});
  const AttributeLayout all = joined(std::vector{one, two, one});
  ASSERT_EQ(all.fields().size(), 3U);
  EXPECT_EQ(all.find("intensity")->attribute.type, kUint16);
  EXPECT_EQ(all.find("angle")->attribute, (Attribute{.name = "angle", .type = kFloat64}));
  EXPECT_EQ(all.find("time")->at, 10U);
  EXPECT_EQ(all.record_size(), 18U);
  EXPECT_TRUE(joined(std::vector{one, one}) == one);
  EXPECT_TRUE(joined({}).empty());
  EXPECT_EQ(chosen(all, {.names = {"time", "none"}}).record_size(), 8U);
  EXPECT_TRUE(chosen(all, {.all = true}) == all);
}

TEST(AttributeNames, OfOtherProgramsAreThoseOfLas) {
  EXPECT_EQ(attribute_name("class"), "classification");
  EXPECT_EQ(attribute_name("Classification"), "classification");
  EXPECT_EQ(attribute_name("GpsTime"), "gps_time");
  EXPECT_EQ(attribute_name("gps time"), "gps_time");
  EXPECT_EQ(attribute_name("ScanAngleRank"), "scan_angle");
  EXPECT_EQ(attribute_name("R"), "red");
  EXPECT_EQ(attribute_name("Pulse Width"), "Pulse Width");
}

}  // namespace
}  // namespace spillway::test

// Between records of the engine and columns of a program.

#include "stream/library/points/attribute_records.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tests/error_facts.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Each type once, so that numbers in records are not aligned.
std::vector<Attribute> all_types() {
  std::vector<Attribute> all;
  for (int type = 0; type <= static_cast<int>(NumberType::kFloat64); ++type) {
    all.push_back({.name = "a" + std::to_string(type),
                   .type = static_cast<NumberType>(type),
                   .elements = 1 + static_cast<std::size_t>(type % 3)});
  }
  return all;
}

std::vector<std::byte> random_bytes(std::size_t count) {
  std::mt19937 random(7);
  std::vector<std::byte> bytes(count);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

TEST(AttributeRecords, ComeBackFromColumnsBitForBit) {
  const AttributeLayout layout(all_types());
  const std::vector<std::byte> records = random_bytes(50 * layout.record_size());
  const AttributeColumns columns = columns_of(layout, records);
  EXPECT_EQ(columns.size(), 50U);
  EXPECT_EQ(columns.attributes(), all_types());
  EXPECT_EQ(records_of(columns, layout, 0, 50), records);
}

TEST(AttributeRecords, OfSomePointsHaveTheNumbersOfThese) {
  AttributeColumns columns({{.name = "n", .type = NumberType::kUint8, .elements = 2}}, 4);
  for (std::size_t i = 0; i < 8; ++i) {
    columns.values<std::uint8_t>("n")[i] = static_cast<std::uint8_t>(i);
  }
  const AttributeLayout layout(columns.attributes());
  EXPECT_THAT(records_of(columns, layout, 1, 2),
              ElementsAre(std::byte{2}, std::byte{3}, std::byte{4}, std::byte{5}));
}

TEST(AttributeRecords, HaveThoseAttributesAloneThatAreWanted) {
  const AttributeLayout layout(all_types());
  const AttributeLayout wanted = chosen(layout, {.names = {"a3", "a9", "unknown"}});
  const std::vector<std::byte> records = random_bytes(20 * layout.record_size());
  const AttributeColumns all = columns_of(layout, records);
  const AttributeColumns part = columns_of(wanted, records_of(all, wanted, 0, 20));
  EXPECT_EQ(part.attributes(), wanted.attributes());
  for (const Attribute& attribute : wanted.attributes()) {
    EXPECT_TRUE(std::ranges::equal(part.bytes(attribute.name), all.bytes(attribute.name)));
  }
  EXPECT_TRUE(columns_of({}, {}).empty());
}

TEST(AttributeRecords, AreMadeOfTheAttributesThatAHeaderTellsAndNoOthers) {
  const Attribute a{.name = "a", .type = NumberType::kUint8};
  const Attribute b{.name = "b", .type = NumberType::kUint8};
  Attribute wide = a;
  wide.type = NumberType::kUint16;
  const auto error_of = [](const AttributeColumns& columns, const std::vector<Attribute>& told) {
    const auto error =
        thrown_by([&] { check_columns(columns, AttributeLayout(told), 3, "vertices"); });
    EXPECT_TRUE(!error || error->code() == ErrorCode::kInvalidArgument);
    return error ? std::string(error->what()) : std::string();
  };
  EXPECT_EQ(error_of({}, {}), "");
  EXPECT_EQ(error_of(AttributeColumns({b, a}, 3), {a, b}), "");
  EXPECT_THAT(error_of({}, {a}), HasSubstr("vertices come without attribute \"a\""));
  EXPECT_THAT(error_of(AttributeColumns({wide}, 3), {a}), HasSubstr("without attribute \"a\""));
  EXPECT_THAT(error_of(AttributeColumns({a, b}, 3), {a}), HasSubstr("with attribute \"b\""));
  EXPECT_THAT(error_of(AttributeColumns({a}, 2), {a}),
              HasSubstr("3 vertices, but attributes of 2"));
}

TEST(AttributeRecords, AreChosenByTheNamesThatOtherProgramsHave) {
  const AttributeChoice choice = attribute_choice({"Class", "GpsTime"});
  EXPECT_FALSE(choice.all);
  EXPECT_THAT(choice.names, ElementsAre("classification", "gps_time"));
  EXPECT_THAT(names_of(choice), ElementsAre("classification", "gps_time"));
  EXPECT_TRUE(attribute_choice({"all"}).all);
  EXPECT_THAT(names_of(attribute_choice({"all"})), ElementsAre("all"));
  EXPECT_TRUE(attribute_choice({}).empty());
}

}  // namespace
}  // namespace spillway::test

// What points carry, in a program's memory: <spillway/attribute_columns.h>.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/attribute_columns.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/error_facts.h"

namespace spillway {
namespace {

using test::thrown_by;

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Attribute kClass{.name = "classification", .type = NumberType::kUint8};
const Attribute kAngle{
    .name = "scan_angle", .type = NumberType::kInt16, .scale = 0.5, .offset = -1};
const Attribute kNormal{.name = "normal", .type = NumberType::kFloat32, .elements = 3};

TEST(AttributeColumns, AreZeroAndOfTheirShapeUntilTheyAreFilled) {
  AttributeColumns columns({kClass, kNormal}, 2);
  EXPECT_EQ(columns.size(), 2U);
  EXPECT_THAT(std::as_const(columns).values<std::uint8_t>("classification"), ElementsAre(0, 0));
  EXPECT_EQ(columns.values<float>("normal").size(), 6U);
  EXPECT_THAT(columns.values<float>("normal"), Each(0.0F));
  columns.values<float>("normal")[5] = 1.5F;
  EXPECT_THAT(std::as_const(columns).values<float>("normal"), ElementsAre(0, 0, 0, 0, 0, 1.5F));
  EXPECT_TRUE(AttributeColumns().empty());
  EXPECT_EQ(AttributeColumns().size(), 0U);
}

TEST(AttributeColumns, MeanNumberTimesScalePlusOffset) {
  AttributeColumns columns({kAngle}, 2);
  columns.values<std::int16_t>("scan_angle")[1] = -30;
  EXPECT_THAT(columns.meant("scan_angle"), ElementsAre(-1.0, -16.0));
}

TEST(AttributeColumns, KeepTheirNumbersWhereTheyGrow) {
  AttributeColumns columns({kClass}, 1);
  columns.values<std::uint8_t>("classification")[0] = 7;
  AttributeColumns more({kClass}, 2);
  more.values<std::uint8_t>("classification")[1] = 9;
  columns.append(more);
  EXPECT_THAT(columns.values<std::uint8_t>("classification"), ElementsAre(7, 0, 9));
  columns.resize(4);
  EXPECT_THAT(columns.values<std::uint8_t>("classification"), ElementsAre(7, 0, 9, 0));
  const auto error = thrown_by([&] { columns.append(AttributeColumns({kAngle}, 1)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
}

TEST(AttributeColumns, NameWhatThereIsWhereAnotherNameOrTypeIsAskedFor) {
  const AttributeColumns columns({kClass, kAngle}, 1);
  const auto unknown = thrown_by([&] { static_cast<void>(columns.values<double>("intensity")); });
  ASSERT_TRUE(unknown);
  EXPECT_EQ(unknown->code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(unknown->what(), HasSubstr("\"intensity\": choose of classification, scan_angle"));
  const auto other = thrown_by([&] { static_cast<void>(columns.values<int>("scan_angle")); });
  ASSERT_TRUE(other);
  EXPECT_EQ(other->code(), ErrorCode::kInvalidArgument);
  EXPECT_THAT(other->what(), HasSubstr("type int16, not int32"));
  const auto none = thrown_by([&] { static_cast<void>(AttributeColumns().meant("intensity")); });
  ASSERT_TRUE(none);
  EXPECT_THAT(none->what(), HasSubstr("they have none"));
}

TEST(AttributeColumns, RefuseAttributesThatCannotBe) {
  const auto error_of = [](std::vector<Attribute> attributes) {
    const auto error = thrown_by([&] { AttributeColumns columns(std::move(attributes)); });
    EXPECT_TRUE(!error || error->code() == ErrorCode::kInvalidArgument);
    return error ? std::string(error->what()) : std::string();
  };
  EXPECT_THAT(error_of({kClass, kAngle}), IsEmpty());
  EXPECT_THAT(error_of({kClass, kAngle, kClass}), HasSubstr("called \"classification\""));
  EXPECT_THAT(error_of({Attribute{.name = ""}}), HasSubstr("no name"));
  EXPECT_THAT(error_of({Attribute{.name = "a", .elements = 0}}), HasSubstr("0 elements"));
  EXPECT_THAT(error_of({Attribute{.name = "a", .elements = std::size_t{1} << 60}}),
              HasSubstr("give 1 to 1000000"));
  EXPECT_THAT(error_of({Attribute{.name = "a", .scale = 0}}), HasSubstr("scale 0"));
  EXPECT_THAT(error_of({Attribute{.name = "a", .offset = std::nan("")}}), HasSubstr("offset nan"));
  EXPECT_THAT(error_of({Attribute{.name = "a", .type = static_cast<NumberType>(10)}}),
              HasSubstr("no type of numbers of number 10"));
}

}  // namespace
}  // namespace spillway

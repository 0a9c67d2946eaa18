#include "formats/bytes/json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace spillway::test {
namespace {

TEST(Json, MembersKeepTheirOrder) {
  Json json = {{"z", 1}, {"a", nullptr}, {"list", std::vector<std::string>{"x", "y"}}};
  json["b"] = {{"min", std::array{0.5, -1.0}}, {"empty", Json::array()}};
  json["z"] = true;
  EXPECT_EQ(json_to_text(json),
            R"({"z":true,"a":null,"list":["x","y"],"b":{"min":[0.5,-1.0],"empty":[]}})");
  EXPECT_EQ(json_to_text(Json{{"a", 1}}, 2), "{\n  \"a\": 1\n}");
}

TEST(Json, NumbersKeepTheirValues) {
  EXPECT_EQ(json_to_text(18446744073709551615U), "18446744073709551615");
  EXPECT_EQ(json_to_text(-9223372036854775807 - 1), "-9223372036854775808");
  EXPECT_EQ(json_to_text(0.1), "0.1");
  EXPECT_EQ(json_to_text(1e300), "1e+300");
  EXPECT_EQ(Json(5), Json(5U));
  EXPECT_NE(Json(5), Json(5.0));
  EXPECT_EQ(parse_json("-3").number(), -3);
}

TEST(Json, TextThatIsNoUtf8IsReplaced) {
  EXPECT_EQ(json_to_text("a\xff\"\n"), "\"a\xEF\xBF\xBD\\\"\\n\"");
}

TEST(Json, WhatIsReadIsWhatWasWritten) {
  const std::string text = R"({"a":[1,-2,2.5,"t",null,true],"b":{},"c":[]})";
  const Json json = parse_json(text);
  EXPECT_EQ(json_to_text(json), text);
  ASSERT_NE(json.find("a"), nullptr);
  EXPECT_EQ(json.find("a")->elements().size(), 6U);
  EXPECT_EQ(json.find("nothing"), nullptr);
  EXPECT_EQ(json.find("a")->find("a"), nullptr);
}

TEST(Json, WrongTextIsToldWithItsPlace) {
  try {
    static_cast<void>(parse_json("{\"a\": x}"));
    ADD_FAILURE() << "this is not JSON";
  } catch (const JsonError& error) {
    EXPECT_EQ(error.byte(), 7U);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("invalid literal"));
  }
  EXPECT_THROW(static_cast<void>(parse_json(std::string(100'000, '['))), JsonError);
}

}  // namespace
}  // namespace spillway::test

// Conditions: what holds, what is no condition, and where that is said to be.

#include "stream/source/condition/condition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "src/error.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Whether the condition holds of a point with these numbers.
bool holds(const std::string& text, const std::map<std::string, double>& numbers) {
  const Condition condition(text);
  std::vector<std::vector<double>> columns;
  for (const std::string& name : condition.names()) columns.push_back({numbers.at(name)});
  return condition.holds(columns, 1)[0];
}

std::string error_of(const std::string& text) {
  try {
    const Condition condition(text);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "none";
}

TEST(Condition, ComparesNumbersAndNames) {
  const std::map<std::string, double> point = {{"intensity", 200}, {"z", -3.5}, {"a b", 1e10}};
  EXPECT_TRUE(holds("intensity = 200", point));
  EXPECT_TRUE(holds("Intensity == 2e2", point));
  EXPECT_FALSE(holds("intensity != 200", point));
  EXPECT_FALSE(holds("intensity<>200", point));
  EXPECT_TRUE(holds("z < -3", point));
  EXPECT_FALSE(holds("z<-3.5", point));
  EXPECT_TRUE(holds("z <= -3.5 and -4 < z", point));
  EXPECT_TRUE(holds("\"a b\" >= 1e+10", point));
  EXPECT_TRUE(holds("z < intensity", point));
  EXPECT_TRUE(holds("+1 > .5", point));
  EXPECT_TRUE(holds("z < -1e-5 and z>-3.6e+2", point));
  EXPECT_TRUE(holds("intensity > .5e-3 and intensity < +2.5E+2", point));
}

TEST(Condition, BindsNotTighterThanAndTighterThanOr) {
  for (int bits = 0; bits < 8; ++bits) {
    const bool a = (bits & 1) != 0;
    const bool b = (bits & 2) != 0;
    const bool c = (bits & 4) != 0;
    const std::map<std::string, double> point = {
        {"p", a ? 1 : 0}, {"q", b ? 1 : 0}, {"s", c ? 1 : 0}};
    EXPECT_EQ(holds("p or q and s", point), a || (b && c));
    EXPECT_EQ(holds("(p or q) and s", point), (a || b) && c);
    EXPECT_EQ(holds("NOT p AND q OR s", point), (!a && b) || c);
    EXPECT_EQ(holds("not (p and q) and not not s", point), !(a && b) && c);
  }
}

TEST(Condition, KnowsListsAndReturns) {
  EXPECT_TRUE(holds("class in (2, 9)", {{"classification", 9}}));
  EXPECT_FALSE(holds("class in (2, 9)", {{"classification", 3}}));
  EXPECT_TRUE(holds("class not in (2, 9)", {{"classification", 3}}));
  const auto return_of = [](double number, double count) {
    return std::map<std::string, double>{{"return_number", number}, {"number_of_returns", count}};
  };
  EXPECT_TRUE(holds("first", return_of(1, 3)));
  EXPECT_FALSE(holds("last", return_of(1, 3)));
  EXPECT_TRUE(holds("last and not first", return_of(3, 3)));
  EXPECT_TRUE(holds("single", return_of(1, 1)));
  EXPECT_FALSE(holds("single", return_of(2, 2)));
  EXPECT_TRUE(holds("first and last", return_of(0, 0))) << "not known";
}

TEST(Condition, HoldsForNoComparisonWithWhatIsNoNumber) {
  const std::map<std::string, double> point = {{"v", std::nan("")}};
  for (const char* const text : {"v < 1", "v >= 1", "v = v", "v in (1, v)"}) {
    EXPECT_FALSE(holds(text, point)) << text;
  }
  EXPECT_TRUE(holds("v != v", point));
}

TEST(Condition, NamesWhatItLooksAtOnceEach) {
  EXPECT_THAT(Condition("Class = 2 or class = 9 and z > 3 and single").names(),
              ElementsAre("classification", "z", "return_number", "number_of_returns"));
}

TEST(Condition, SaysWhereItCannotBeRead) {
  EXPECT_THAT(error_of(""), HasSubstr("a name or a number is missing at its end"));
  EXPECT_THAT(error_of("z >"), HasSubstr("a name or a number is missing at its end"));
  EXPECT_THAT(error_of("z > 3 4"), HasSubstr("is expected before '4'"));
  EXPECT_THAT(error_of("(z > 3"), HasSubstr("\")\" is missing at its end"));
  EXPECT_THAT(error_of("z in 3"), HasSubstr("\"(\" is missing before '3'"));
  EXPECT_THAT(error_of("z not 3"), HasSubstr("\"in\" is missing before '3'"));
  EXPECT_THAT(error_of("3"), HasSubstr("a comparison is missing"));
  EXPECT_THAT(error_of("z > 3x"), HasSubstr("expected before '3x'"));
  EXPECT_THAT(error_of("z = nan"), HasSubstr("expected before 'nan'"));
  EXPECT_THAT(error_of("z < inf"), HasSubstr("expected before 'inf'"));
  EXPECT_THAT(error_of("\"z > 3"), HasSubstr("a name in quotes does not end"));
  EXPECT_THAT(error_of("z & 3"), HasSubstr("before '& 3'"));
  EXPECT_THAT(error_of(std::string(5000, '(')), HasSubstr("too many brackets"));
}

}  // namespace
}  // namespace spillway::test

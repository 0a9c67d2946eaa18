// Which coordinate system several inputs have together, and what is said where they differ.

#include "stream/source/input_crs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "src/error.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class InputCrsTest : public ::testing::Test {
 protected:
  std::string common(const std::vector<InputCrs>& inputs, bool force = false,
                     const std::string& given = "") {
    return common_crs(inputs, {given, force},
                      [this](std::string_view text) { said_ += std::string(text) + "\n"; });
  }

  std::string said_;
};

TEST_F(InputCrsTest, IsThatOfTheFirstInputThatNamesOne) {
  EXPECT_EQ(common({}), "");
  EXPECT_EQ(common({{"a", ""}, {"b", ""}}), "");
  EXPECT_EQ(common({{"a", "here"}, {"b", "here"}}), "here");
  EXPECT_EQ(said_, "");
}

TEST_F(InputCrsTest, InputsThatNameNoneTakeThatOfTheOthers) {
  EXPECT_EQ(common({{"a", ""}, {"b", "here"}, {"c", ""}}), "here");
  EXPECT_EQ(said_, "warning: a (and 1 more) names no coordinate system; taken to be that of b\n");
}

TEST_F(InputCrsTest, ANoteIsSaidOnceOfAllInputsThatHaveIt) {
  EXPECT_EQ(common({{"a", "", "odd"}, {"b", "", "odd"}, {"c", "", "strange"}}), "");
  EXPECT_EQ(said_,
            "warning: a (and 1 more): taken to have no coordinate system: odd\n"
            "warning: c: taken to have no coordinate system: strange\n");
  said_.clear();
  EXPECT_EQ(common({{"a", "", "odd"}, {"b", "here", "odd"}}), "here");
  EXPECT_EQ(said_, "warning: a: taken to have the coordinate system of b: odd\n");
}

TEST_F(InputCrsTest, DifferentSystemsAreRefused) {
  try {
    common({{"a", "EPSG:32632"}, {"b", "EPSG:32633"}});
    FAIL() << "no error";
  } catch (const Failure& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("b has the coordinate system EPSG:32633"),
                                    HasSubstr("but a has EPSG:32632")));
    EXPECT_EQ(error.facts().file, "b");
    EXPECT_EQ(error.facts().remedy, Remedy::kForeignCrs);
  }
}

TEST_F(InputCrsTest, DifferentSystemsAreSaidOnceEachWhereTheyAreForced) {
  EXPECT_EQ(common({{"a", "here"}, {"b", "there"}, {"c", "there"}}, true), "here");
  EXPECT_EQ(said_,
            "warning: b has the coordinate system there, but a has here; coordinates are taken as "
            "they are\n");
}

TEST_F(InputCrsTest, TheGivenOneIsThatOfInputsThatNameNone) {
  EXPECT_EQ(common({{"a", ""}, {"b", "", "odd"}, {"c", "here"}}, false, "here"), "here");
  EXPECT_EQ(said_, "") << "whoever gives it knows";
}

TEST_F(InputCrsTest, TheGivenOneReplacesOthersOnlyWhereThatIsForced) {
  const std::vector<InputCrs> inputs = {{"a", ""}, {"b", "there"}, {"c", "there"}};
  try {
    common(inputs, false, "here");
    FAIL() << "no error";
  } catch (const Failure& error) {
    EXPECT_STREQ(error.what(),
                 "b has the coordinate system there, but here is given; leave that out, or put it "
                 "in the place of what files tell");
    EXPECT_EQ(error.facts().file, "b");
    EXPECT_EQ(error.facts().remedy, Remedy::kForeignCrs);
  }
  EXPECT_EQ(common(inputs, true, "here"), "here");
  EXPECT_EQ(said_,
            "warning: b has the coordinate system there; coordinates are taken as they are, to be "
            "in here\n");
}

TEST_F(InputCrsTest, ALongTextWithoutANameIsCutInMessages) {
  common({{"a", "here"}, {"b", std::string(100, 'x')}}, true);
  EXPECT_THAT(said_, HasSubstr("b has the coordinate system " + std::string(60, 'x') + "..., but"));
}

}  // namespace
}  // namespace spillway::test

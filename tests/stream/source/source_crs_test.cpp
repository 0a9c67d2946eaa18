// When GDAL is asked about what headers tell, and what is made of what it cannot read.

#include "stream/source/source_crs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "formats/gdal/gdal.h"
#include "tests/formats/with_gdal.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kBroken = "PROJCS[\"no such thing\",FOO[1]]";

/// Keys of a projected system, and of heights unless that is 0.
GeotiffKeys keys_of(std::uint16_t code, std::uint16_t heights) {
  const std::array<std::uint16_t, 16> keys = {1,    1, 0, 3,    1024, 0, 1, 1,
                                              3072, 0, 1, code, 4096, 0, 1, heights};
  const auto bytes = std::as_bytes(std::span(keys));
  return {.directory = {bytes.begin(), bytes.end()}};
}

class SourceCrs : public ::testing::Test {
 protected:
  void add(const std::string& name, const std::string& crs, const GeotiffKeys& keys = {}) {
    PointHeader& header = facts_.inputs.emplace_back().header;
    header.name = name;
    header.crs = crs;
    header.crs_keys = keys;
  }
  std::string find(const CrsChoice& choice = {}) {
    options_.choice = choice;
    options_.warn = [this](std::string_view text) { said_ += std::string(text) + "\n"; };
    return facts_.crs = find_crs(facts_, options_);
  }
  std::string settle(CrsNeed need) { return settled_crs(facts_, need, options_); }

  SourceFacts facts_;
  SourceCrsOptions options_;
  std::string said_;
};

TEST_F(SourceCrs, OneTextIsBelievedUntilAnOutputNeedsIt) {
  add("a", kBroken);
  add("b", kBroken);
  EXPECT_EQ(find(), kBroken);
  EXPECT_EQ(settle(CrsNeed::kNone), kBroken);
  EXPECT_EQ(settle(CrsNeed::kCodes), kBroken) << "WKT goes along as it is";
  EXPECT_EQ(said_, "");
}

TEST_F(SourceCrs, ThatCannotBeReadIsNoneWithAWarning) {
  if (!with_gdal()) GTEST_SKIP() << "GDAL reads it";
  add("a", kBroken);
  add("b", kBroken);
  find();
  EXPECT_EQ(settle(CrsNeed::kAll), "");
  EXPECT_THAT(said_, HasSubstr("warning: a (and 1 more): taken to have no coordinate system: what "
                               "it tells of its coordinate system cannot be read: \"PROJCS["));
}

TEST_F(SourceCrs, ThatCannotBeReadGivesWayToKeys) {
  if (!with_gdal()) GTEST_SKIP() << "GDAL reads it";
  add("a", kBroken, keys_of(25832, 0));
  find();
  EXPECT_EQ(settle(CrsNeed::kAll), "EPSG:25832");
  EXPECT_EQ(said_, "");
}

TEST_F(SourceCrs, BesideOthersIsReadAtOnce) {
  if (!with_gdal()) GTEST_SKIP() << "GDAL compares them";
  add("a", kBroken);
  add("b", "EPSG:25832");
  EXPECT_EQ(find(), "EPSG:25832");
  EXPECT_THAT(said_, HasSubstr("warning: a: taken to have the coordinate system of b: what it"));
  said_.clear();
  EXPECT_EQ(settle(CrsNeed::kAll), "EPSG:25832");
  EXPECT_EQ(said_, "") << "it has been said";
}

TEST_F(SourceCrs, HeightsOfKeysComeWithTheNeed) {
  if (!with_gdal()) GTEST_SKIP() << "GDAL makes a system of them";
  add("a", "EPSG:25832", keys_of(25832, 5783));
  add("b", "EPSG:25832", keys_of(25832, 5783));
  EXPECT_EQ(find(), "EPSG:25832");
  for (const CrsNeed need : {CrsNeed::kCodes, CrsNeed::kAll}) {
    EXPECT_TRUE(gdal().same_crs(settle(need), "EPSG:25832+5783"));
  }
  EXPECT_EQ(said_, "");
}

TEST_F(SourceCrs, TheGivenOneStandsWhateverCannotBeRead) {
  if (!with_gdal()) GTEST_SKIP() << "GDAL compares them";
  add("a", kBroken);
  add("b", "");
  EXPECT_EQ(find({.given = "EPSG:25832"}), "EPSG:25832");
  EXPECT_EQ(settle(CrsNeed::kAll), "EPSG:25832");
  EXPECT_EQ(said_, "");
}

}  // namespace
}  // namespace spillway::test

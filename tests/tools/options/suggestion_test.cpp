#include "tools/options/suggestion.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace spillway::test {
namespace {

const std::vector<std::string> kOptions = {"-h",       "--help",        "-o",      "--output",
                                           "-q",       "--quiet",       "--dim",   "--id",
                                           "--bounds", "--tile-points", "--thin",  "--memory",
                                           "--stats",  "--crs",         "--every", "--heights"};

std::string meant(const std::string& word) { return suggestion(word, kOptions); }

TEST(Suggestion, IsWhatIsASlipAway) {
  EXPECT_EQ(meant("--boundz"), " (did you mean --bounds?)");
  EXPECT_EQ(meant("--quite"), " (did you mean --quiet?)") << "two letters that change places";
  EXPECT_EQ(meant("--tile-ponts"), " (did you mean --tile-points?)");
  EXPECT_EQ(meant("--dmi"), " (did you mean --dim?)");
  EXPECT_EQ(meant("--stat"), " (did you mean --stats?)");
}

TEST(Suggestion, LongWordsMayHaveMoreSlips) {
  EXPECT_EQ(meant("--tiel-piont"), " (did you mean --tile-points?)");
  EXPECT_EQ(meant("--memroi"), " (did you mean --memory?)");
}

TEST(Suggestion, ABeginningIsEnough) {
  EXPECT_EQ(meant("--mem"), " (did you mean --memory?)");
  EXPECT_EQ(meant("--outp"), " (did you mean --output?)");
}

TEST(Suggestion, ThereIsNoneForWhatIsNearToNothing) {
  for (const char* const word : {"--x", "--zz", "--me", "--foo", "--fast", "--zzzz", "--colour",
                                 "--resample", "--", "", "--mesh", "--epsg", "--verbosity"}) {
    EXPECT_EQ(meant(word), "") << word;
  }
}

TEST(Suggestion, TakesSubcommandsToo) {
  const std::vector<std::string> words = {"triangulate", "dem", "contour", "info", "check"};
  EXPECT_EQ(suggestion("triangluate", words), " (did you mean triangulate?)");
  EXPECT_EQ(suggestion("triangle", words), " (did you mean triangulate?)");
  EXPECT_EQ(suggestion("chek", words), " (did you mean check?)");
  EXPECT_EQ(suggestion("survey.las", words), "");
  EXPECT_EQ(suggestion("mesh", words), "");
}

}  // namespace
}  // namespace spillway::test

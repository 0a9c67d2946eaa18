// What all subcommands have alike: --stats, a word about --memory, and values that shells complete.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using Json = nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Figures : public ::testing::Test {
 protected:
  Figures() {
    work_.succeed("spillway generate terrain -q -n 3000 --seed 2 -o a.las");
    work_.succeed("spillway triangulate -q a.las -o a.spm");
  }

  Json stats(const std::string& arguments) const {
    work_.succeed("spillway " + arguments + " -q --stats s.json > out");
    Json json = Json::parse(work_.read("s.json"));
    EXPECT_TRUE(json["version"].is_string()) << arguments;
    EXPECT_GT(json["peak_rss_bytes"], 0) << arguments;
    EXPECT_GE(json["seconds"], 0) << arguments;
    return json;
  }

  Workspace work_;
};

TEST_F(Figures, OfConvertGenerateCheckInfoAndBatch) {
  const Json points = stats("convert a.las -o b.laz --every 3");
  EXPECT_EQ(points["points"], 1000);
  EXPECT_EQ(points["filters"]["every"], 2000);
  EXPECT_EQ(points["output"], "b.laz");
  EXPECT_EQ(points["inputs"], Json::array({"a.las"}));
  const Json mesh = stats("convert a.spm -o b.ply");
  const Json made = stats("triangulate a.las -o c.spm");
  for (const char* key : {"points", "vertices", "simplices", "hull_facets", "canonical_hash"}) {
    EXPECT_EQ(mesh[key], made[key]) << key;
  }
  const Json generated = stats("generate uniform -n 500 --grid 2x2 -o g_#.npy");
  EXPECT_EQ(generated["points"], 500);
  EXPECT_EQ(generated["output_files"], 4);
  EXPECT_EQ(generated["family"], "uniform");
  const Json proof = stats("check a.spm");
  EXPECT_EQ(proof["proved"], true);
  EXPECT_EQ(proof["canonical_hash"], made["canonical_hash"]);
  const Json info = stats("info a.las a.spm");
  ASSERT_EQ(info["files"].size(), 2U);
  EXPECT_EQ(info["files"][0]["points"], 3000);
  const Json batch = stats("batch a.las --to ply --output-dir out_files");
  EXPECT_EQ(batch["done"], 1);
  EXPECT_EQ(batch["jobs"][0]["status"], "done");
}

TEST_F(Figures, AreAnOptionOfEverySubcommandThatWorks) {
  for (const char* const subcommand : {"triangulate", "convert", "generate", "check", "info",
                                       "batch", "dem", "contour", "render", "height", "volume"}) {
    EXPECT_THAT(work_.succeed(std::string("spillway ") + subcommand + " --help"),
                HasSubstr("\n  --stats FILE "))
        << subcommand;
  }
}

TEST_F(Figures, CannotGoWhereTheOutputGoes) {
  for (const char* const arguments :
       {"convert a.las -o s.csv --stats s.csv", "generate uniform -n 9 -o s.npy --stats s.npy",
        "check a.spm --stats a.spm", "convert a.las -o b.las --stats a.las", "info a.las --stats -",
        "triangulate a.las -o b.ply --stats ./a.las"}) {
    const Result result = work_.run(std::string("spillway ") + arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_THAT(result.err, HasSubstr("cannot go to the same place"));
  }
  EXPECT_EQ(work_.run("spillway convert -q a.las -o b.las --stats no/s.json").exit_code, 1);
  EXPECT_FALSE(work_.has("b.las"));
}

TEST_F(Figures, MoreMemoryThanThereIsIsSaid) {
  const Result result = work_.run("spillway triangulate a.las -o b.ply --memory 900T");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, AllOf(HasSubstr("warning: --memory 900T is more than the "),
                                HasSubstr("that this machine has")));
  EXPECT_THAT(work_.run("spillway triangulate a.las -o b.ply --memory 64M").err,
              Not(HasSubstr("warning")));
  EXPECT_EQ(work_.run("spillway triangulate -q a.las -o b.ply --memory 900T").err, "");
}

TEST(Completion, OffersValuesAndNoPlaceholders) {
  const Workspace work;
  const std::string script = work.succeed("spillway completion bash");
  const auto offers = [&](const std::string& option, const std::string& words) {
    EXPECT_THAT(script, HasSubstr("    " + option + ") words=\"" + words + "\" ;;\n"));
  };
  offers("triangulate:--separator", "comma semicolon tab blanks");
  offers("triangulate:--decimal", "point comma");
  offers("triangulate:--returns", "first last single");
  offers("triangulate:--attributes", "all none");
  offers("triangulate:--tiles", "");
  offers("triangulate:--memory", "256M 512M 1G 2G 4G 8G 16G");
  EXPECT_THAT(script, HasSubstr("dem:--product) words=\"height slope aspect hillshade"));
  EXPECT_THAT(work.succeed("spillway completion zsh"), HasSubstr(":DIR:_files -/"));
}

/// What is needed first comes first; what suits nearly everyone as it is comes last.
TEST(Help, HasOptionsInTheOrderOfNeed) {
  const Workspace work;
  for (const char* const subcommand : {"triangulate", "dem", "contour", "render", "height",
                                       "convert", "info", "check", "volume"}) {
    const std::string help = work.succeed(std::string("spillway ") + subcommand + " --help");
    std::size_t last = 0;
    for (const char* const heading :
         {"\nOptions:\n", "\nFilters (of the points that are read):\n",
          "\nHow text is written (where it does not show):\n", "\nThreads, memory and disk:\n",
          "\nMessages and figures:\n", "\nFine tuning (the defaults suit nearly everyone):\n"}) {
      const std::size_t at = help.find(heading);
      if (at == help.npos) continue;
      EXPECT_GT(at, last) << subcommand << heading;
      last = at;
    }
  }
}

}  // namespace
}  // namespace spillway::test

// Many files whose headers tell where their points lie are triangulated while they are read: the
// result is that of one file, whatever their names, and a header that lies is found out.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"
#include "tests/tools/inputs/las_samples.h"

namespace spillway::detail::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Where a LAS header has the largest x.
constexpr std::size_t kMostX = 179;

class Survey : public ::testing::Test {
 protected:
  Survey() {
    work_.succeed(
        "spillway generate terrain -n 40000 -q -o all.las && "
        "spillway generate terrain -n 40000 -q --grid 7x7 -o 't_#.las'");
  }

  nlohmann::json triangulate(const std::string& arguments) {
    work_.succeed("spillway triangulate -q --tile 2000 -o mesh.spm --stats stats.json " +
                  arguments);
    work_.succeed("spillway check -q mesh.spm");
    return nlohmann::json::parse(work_.read("stats.json"));
  }
  static bool is_early(const nlohmann::json& stats) {
    return stats["first_block_read_points"] < stats["points"].get<std::uint64_t>() / 2;
  }

  /// Makes the header of a file tell another largest x.
  void lie(const std::string& name, double most_x) {
    std::string bytes = work_.read(name);
    std::memcpy(bytes.data() + kMostX, &most_x, sizeof most_x);
    work_.write(name, bytes);
  }

  Workspace work_;
};

TEST_F(Survey, IsTriangulatedEarlyAndAsOneFileWhateverTheNames) {
  const nlohmann::json one = triangulate("all.las");
  EXPECT_EQ(one["first_block_read_points"], 40'000) << "of one file all is read first";
  for (const std::string files : {"t_*.las", "$(ls -r t_*.las)", "$(ls t_*.las | sort -R)"}) {
    const nlohmann::json survey = triangulate(files);
    EXPECT_TRUE(is_early(survey)) << files;
    EXPECT_EQ(survey["canonical_hash"], one["canonical_hash"]) << files;
    EXPECT_EQ(survey["spilled_points"], 0);
  }
}

TEST_F(Survey, TakesOneFileThatCoversAllAndEmptyOnes) {
  work_.write("empty.las", scattered_las(0, 0).bytes());
  work_.succeed(
      "spillway convert -q all.las --every 10 -o tenth.npy && "
      "spillway convert -q all.las --every 10 -o tenth.las");
  const nlohmann::json survey = triangulate("empty.las t_*.las tenth.las");
  EXPECT_TRUE(is_early(survey));
  const nlohmann::json late = triangulate("t_*.las tenth.las --distrust-headers");
  EXPECT_FALSE(is_early(late));
  EXPECT_EQ(survey["canonical_hash"], late["canonical_hash"]);
  EXPECT_EQ(survey["duplicates"], late["duplicates"]);
  EXPECT_FALSE(is_early(triangulate("t_*.las tenth.npy"))) << "an input that tells nothing";
}

TEST_F(Survey, GivesVerticesTheSameHeightsAsWhenAllIsReadFirst) {
  for (const std::string choice : {"first", "lowest", "highest", "mean"}) {
    const std::string arguments =
        "$(ls -r t_*.las) t_*.las all.las -q --tile 2000 --duplicates " + choice;
    work_.succeed("spillway triangulate -o early.obj " + arguments +
                  " && spillway triangulate --distrust-headers -o late.obj " + arguments);
    EXPECT_EQ(work_.succeed("grep ^v early.obj | sort | md5sum"),
              work_.succeed("grep ^v late.obj | sort | md5sum"))
        << choice;
  }
}

TEST_F(Survey, FiltersAndNumbersPointsAsOneFileDoes) {
  const std::string box = "--bounds 500020,4100065,500060,4100120 ";
  EXPECT_EQ(triangulate(box + "t_*.las")["canonical_hash"],
            triangulate(box + "all.las")["canonical_hash"]);
  work_.succeed(
      "spillway triangulate t_*.las -q --id --tile 2000 -o early.npy && "
      "spillway triangulate t_*.las -q --id --tile 2000 --distrust-headers -o late.npy");
  EXPECT_EQ(work_.info("early.npy")["canonical_hash"], work_.info("late.npy")["canonical_hash"]);
}

TEST_F(Survey, APointOutsideOfItsHeadersBoxIsAnErrorThatNamesFileAndPoint) {
  const nlohmann::json truth = triangulate("t_*.las");
  work_.succeed("rm -f mesh.spm stats.json");
  const nlohmann::json info = work_.info("t_04_04.las");
  const double least = info["extent"]["min"][0];
  const double most = info["extent"]["max"][0];
  lie("t_04_04.las", (least + most) / 2);
  const Result lying = work_.run("spillway triangulate t_*.las --tile 2000 -o mesh.spm");
  EXPECT_EQ(lying.exit_code, 1);
  EXPECT_THAT(lying.err, AllOf(HasSubstr("t_04_04.las"), HasSubstr("point "),
                               HasSubstr("outside of the box that the header tells"),
                               HasSubstr("--distrust-headers")));
  EXPECT_FALSE(work_.has("mesh.spm"));
  EXPECT_FALSE(work_.has_unfinished("mesh.spm"));
  EXPECT_EQ(triangulate("t_*.las --distrust-headers")["canonical_hash"], truth["canonical_hash"]);
}

/// Programs round the numbers of a header.
TEST_F(Survey, ABoxThatIsOffByARoundingIsNoLie) {
  const nlohmann::json truth = triangulate("t_*.las");
  const double most = work_.info("t_04_04.las")["extent"]["max"][0];
  lie("t_04_04.las", most - 0.009);
  EXPECT_EQ(triangulate("t_*.las")["canonical_hash"], truth["canonical_hash"]);
}

TEST_F(Survey, TakesManyFilesThatAllCoverOnePlace) {
  for (int file = 10; file < 30; ++file) {
    const std::string name = std::to_string(file);
    work_.succeed("spillway generate terrain -n 8000 -q --seed " + name + " -o x.las");
    work_.succeed("spillway convert -q x.las --bounds 500100,4100100,500200,4100200 -o p_" + name +
                  ".las");
  }
  work_.succeed("spillway convert -q p_*.las -o place.las");
  const nlohmann::json place = triangulate("place.las");
  EXPECT_GT(place["points"], 10'000);
  for (const std::string files : {"p_*.las", "$(ls -r p_*.las)", "p_*.las --distrust-headers"}) {
    EXPECT_EQ(triangulate(files)["canonical_hash"], place["canonical_hash"]) << files;
  }
  work_.succeed("spillway convert -q p_*.las t_*.las -o together.las");
  const nlohmann::json together = triangulate("together.las");
  EXPECT_EQ(together["first_block_read_points"], together["points"]);
  for (const std::string files : {"p_*.las t_*.las", "$(ls -r p_*.las t_*.las)"}) {
    const nlohmann::json survey = triangulate(files);
    EXPECT_TRUE(is_early(survey)) << files;
    EXPECT_EQ(survey["canonical_hash"], together["canonical_hash"]) << files;
  }
}

TEST_F(Survey, PipesAmongFilesAreReadInTheirTurn) {
  const nlohmann::json survey = triangulate("t_00*.las - t_0[1-6]*.las < t_03_03.las");
  EXPECT_EQ(survey["points"], 40'000 + work_.info("t_03_03.las")["points"].get<int>());
}

TEST_F(Survey, ContoursAreThoseOfAllPoints) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  work_.succeed(
      "spillway contour t_*.las -q --tile 2000 --interval 5 -o early.geojson --force-crs --stats "
      "stats.json && "
      "spillway contour t_*.las -q --distrust-headers --interval 5 -o late.geojson --force-crs");
  EXPECT_TRUE(is_early(nlohmann::json::parse(work_.read("stats.json"))));
  const auto lines = [&](const std::string& name) {
    std::vector<std::string> all;
    const auto file = nlohmann::json::parse(work_.read(name));
    for (const auto& line : file["features"]) all.push_back(line.dump());
    std::sort(all.begin(), all.end());
    return all;
  };
  EXPECT_FALSE(lines("late.geojson").empty());
  EXPECT_EQ(lines("early.geojson"), lines("late.geojson"));
}

}  // namespace
}  // namespace spillway::detail::test

// Many files whose headers tell where their points lie are triangulated while they are read: the
// result is that of one file, whatever their names, and a header that lies is found out.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"
#include "tests/tools/inputs/halved_box.h"
#include "tests/tools/inputs/las_samples.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Survey : public ::testing::Test {
 protected:
  Survey() {
    work_.succeed(
        "spillway generate terrain -n 40000 -q -o all.las && "
        "spillway generate terrain -n 40000 -q --grid 7x7 -o 't_#.las'");
  }

  nlohmann::json triangulate(const std::string& arguments) {
    work_.succeed("spillway triangulate -q --tile-points 2000 -o mesh.spm --stats stats.json " +
                  arguments);
    work_.succeed("spillway check -q mesh.spm");
    return nlohmann::json::parse(work_.read("stats.json"));
  }
  static bool is_early(const nlohmann::json& stats) {
    return stats["first_block_read_points"] < stats["points"].get<std::uint64_t>() / 2;
  }

  /// Makes the header of a file tell other bounds along an axis.
  void lie(const std::string& name, std::size_t axis, double least, double most) {
    tell_bounds(work_, name, axis, least, most);
  }
  struct Bounds {
    double least;
    double most;
  };
  [[nodiscard]] Bounds bounds_of(const std::string& name, std::size_t axis) const {
    const nlohmann::json extent = work_.info(name)["extent"];
    return {extent["min"][axis], extent["max"][axis]};
  }
  /// The header of one file tells half of what it should.
  void halve_box(std::size_t axis = 0) { test::halve_box(work_, "t_04_04.las", axis); }
  /// The statistics of a run whose headers turn out to be false.
  nlohmann::json triangulate_again(const std::string& arguments) {
    const Result result = work_.run(
        "spillway triangulate --tile-points 2000 -o mesh.spm --stats stats.json " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    messages_ = result.err;
    work_.succeed("spillway check -q mesh.spm");
    EXPECT_EQ(times(kFalse, messages_), 1) << messages_;
    EXPECT_THAT(messages_, HasSubstr("t_04_04.las: point "));
    return nlohmann::json::parse(work_.read("stats.json"));
  }
  static int times(const std::string& what, const std::string& text) {
    int count = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
      ++count;
    }
    return count;
  }

  static constexpr const char* kFalse = "outside of the box that the header tells";

  Workspace work_;
  std::string messages_;
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
  const nlohmann::json late = triangulate("t_*.las tenth.las --no-trust-headers");
  EXPECT_FALSE(is_early(late));
  EXPECT_EQ(survey["canonical_hash"], late["canonical_hash"]);
  EXPECT_EQ(survey["duplicates"], late["duplicates"]);
  EXPECT_FALSE(is_early(triangulate("t_*.las tenth.npy"))) << "an input that tells nothing";
}

TEST_F(Survey, GivesVerticesTheSameHeightsAsWhenAllIsReadFirst) {
  for (const std::string choice : {"first", "lowest", "highest", "mean"}) {
    const std::string arguments =
        "$(ls -r t_*.las) t_*.las all.las -q --tile-points 2000 --heights " + choice;
    work_.succeed("spillway triangulate -o early.obj " + arguments +
                  " && spillway triangulate --no-trust-headers -o late.obj " + arguments);
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
      "spillway triangulate t_*.las -q --id --tile-points 2000 -o early.npy && "
      "spillway triangulate t_*.las -q --id --tile-points 2000 --no-trust-headers -o late.npy");
  EXPECT_EQ(work_.info("early.npy")["canonical_hash"], work_.info("late.npy")["canonical_hash"]);
}

TEST_F(Survey, BeginsAgainWhereAPointLiesOutsideOfItsHeadersBox) {
  const nlohmann::json truth = triangulate("t_*.las");
  for (const std::size_t axis : {0U, 1U}) {
    const Bounds bounds = bounds_of("t_04_04.las", axis);
    halve_box(axis);
    const nlohmann::json again = triangulate_again("t_*.las");
    EXPECT_THAT(messages_, HasSubstr("all points are read again"));
    EXPECT_EQ(again["canonical_hash"], truth["canonical_hash"]) << axis;
    EXPECT_EQ(again["points"], 40'000);
    EXPECT_EQ(again["first_block_read_points"], 40'000);
    EXPECT_FALSE(work_.has_unfinished("mesh.spm"));
    EXPECT_EQ(triangulate("t_*.las --no-trust-headers")["canonical_hash"], truth["canonical_hash"]);
    lie("t_04_04.las", axis, bounds.least, bounds.most);
  }
}

TEST_F(Survey, BeginsAgainInSpaceWhereAHeightLiesOutsideOfItsHeadersBox) {
  const nlohmann::json truth = triangulate("--dim 3 t_*.las");
  EXPECT_TRUE(is_early(truth));
  halve_box(2);
  EXPECT_TRUE(is_early(triangulate("t_*.las"))) << "in the plane heights do not matter";
  EXPECT_EQ(triangulate_again("--dim 3 t_*.las")["canonical_hash"], truth["canonical_hash"]);
}

TEST_F(Survey, TakesBoxesOfOnePlaceForFalseOnesAndInvertedOnesForNone) {
  const nlohmann::json truth = triangulate("t_*.las");
  const Bounds bounds = bounds_of("t_04_04.las", 0);
  lie("t_04_04.las", 0, bounds.least, bounds.least);
  EXPECT_EQ(triangulate_again("t_*.las")["canonical_hash"], truth["canonical_hash"]);
  lie("t_04_04.las", 0, bounds.most, bounds.least);
  const nlohmann::json late = triangulate("t_*.las");
  EXPECT_FALSE(is_early(late));
  EXPECT_EQ(late["canonical_hash"], truth["canonical_hash"]);
}

TEST_F(Survey, CountsNothingTwiceWhenItBeginsAgain) {
  halve_box();
  for (const std::string filter :
       {"--every 3", "--keep-class 0", "--id", "--bounds 500020,4100065,500350,4100280"}) {
    const nlohmann::json again = triangulate_again("t_*.las " + filter);
    const nlohmann::json late = triangulate("t_*.las --no-trust-headers " + filter);
    for (const char* key : {"canonical_hash", "points", "duplicates", "vertices", "simplices",
                            "filters", "tiles", "leaves", "spilled_points"}) {
      EXPECT_EQ(again[key], late[key]) << filter << " " << key;
    }
  }
  EXPECT_EQ(triangulate("t_*.las --thin 3")["filters"]["read"], 40'000);
}

TEST_F(Survey, SaysInItsTasksWhereItBeginsAgain) {
  halve_box();
  const nlohmann::json again = triangulate_again("t_*.las --tasks tasks.jsonl");
  const std::string tasks = work_.read("tasks.jsonl");
  const std::string line = "{\"begun_again\":true}\n";
  ASSERT_EQ(times(line, tasks), 1);
  const std::string valid = tasks.substr(tasks.find(line) + line.size());
  EXPECT_EQ(times("\"level\":0", valid), again["tiles"]);
}

TEST_F(Survey, EndsEachPhaseBeforeItBeginsAgain) {
  halve_box();
  const std::string lines =
      work_.run("spillway triangulate --tile-points 2000 t_*.las -o mesh.spm --progress json").err;
  std::vector<std::string> phases;
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) {
    const auto json = nlohmann::json::parse(line);
    if (json.value("finished", false)) phases.push_back(json["phase"]);
    if (json.contains("message")) phases.emplace_back("message");
  }
  EXPECT_THAT(phases, ElementsAre("read", "message", "read", "triangulate", "write", "message"));
}

TEST_F(Survey, LeavesOneFileOfEachFormatWhenItBeginsAgain) {
  halve_box();
  const std::size_t before = work_.names().size();
  for (const std::string format : {"ply", "obj", "vtu", "sma", "glb"}) {
    const std::string run =
        "spillway triangulate -q --tile-points 2000 --scratch-folder . t_*.las -o mesh." + format;
    work_.succeed(run);
    EXPECT_EQ(work_.names().size(), before + 1) << format;
    work_.succeed("spillway check -q mesh." + format + " && rm mesh." + format);
  }
}

TEST_F(Survey, AFalseBoxIsAnErrorWhereTheMeshHasLeftThroughAPipe) {
  halve_box();
  for (const std::string format : {"spm", "ply"}) {
    const Result lying =
        work_.run("spillway triangulate t_*.las --tile-points 2000 -o - --output-format " + format +
                  " >piped");
    EXPECT_EQ(lying.exit_code, 1);
    EXPECT_THAT(lying.err, AllOf(HasSubstr("t_04_04.las: point "), HasSubstr(kFalse),
                                 HasSubstr("--no-trust-headers"), Not(HasSubstr("again"))));
  }
}

TEST_F(Survey, AFalseBoxIsAnErrorWhereAnInputIsAPipe) {
  halve_box();
  const Result lying = work_.run(
      "spillway triangulate t_0[0-5]*.las - --tile-points 2000 -o mesh.spm < t_06_06.las");
  EXPECT_EQ(lying.exit_code, 1);
  EXPECT_THAT(lying.err, AllOf(HasSubstr(kFalse), HasSubstr("--no-trust-headers")));
  EXPECT_FALSE(work_.has("mesh.spm"));
  EXPECT_FALSE(work_.has_unfinished("mesh.spm"));
}

/// Programs round the numbers of a header.
TEST_F(Survey, ABoxThatIsAStepOffIsNotFalse) {
  const nlohmann::json truth = triangulate("t_*.las");
  const Bounds bounds = bounds_of("t_04_04.las", 0);
  for (const double off : {0.009, 0.01}) {
    lie("t_04_04.las", 0, bounds.least + off, bounds.most - off);
    const Result survey = work_.run("spillway triangulate t_*.las --tile-points 2000 -o mesh.spm");
    EXPECT_EQ(survey.exit_code, 0) << survey.err;
    EXPECT_THAT(survey.err, Not(HasSubstr(kFalse))) << off;
    EXPECT_EQ(work_.info("mesh.spm")["canonical_hash"], truth["canonical_hash"]);
    EXPECT_EQ(work_.info("t_04_04.las")["points_outside"], 0) << off;
  }
}

TEST_F(Survey, InfoTellsOfAFalseBox) {
  EXPECT_EQ(work_.info("t_04_04.las")["header_box"], work_.info("t_04_04.las")["extent"]);
  EXPECT_EQ(work_.info("t_04_04.las")["points_outside"], 0);
  const Bounds bounds = bounds_of("t_04_04.las", 2);
  halve_box(2);
  const nlohmann::json info = work_.info("t_04_04.las");
  EXPECT_EQ(info["header_box"]["max"][2], (bounds.least + bounds.most) / 2);
  EXPECT_EQ(info["extent"]["max"][2], bounds.most);
  EXPECT_GT(info["points_outside"], 0);
  EXPECT_LT(info["points_outside"], info["points"]);
  const std::string text = work_.succeed("spillway info -q t_04_04.las");
  EXPECT_THAT(text, HasSubstr("  points_outside   " + info["points_outside"].dump() + "\n"));
  work_.succeed("spillway convert -q t_04_04.las -o t.txt");
  EXPECT_TRUE(work_.info("t.txt")["header_box"].is_null());
  EXPECT_TRUE(work_.info("t.txt")["points_outside"].is_null());
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
  for (const std::string files : {"p_*.las", "$(ls -r p_*.las)", "p_*.las --no-trust-headers"}) {
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
      "spillway contour t_*.las -q --tile-points 2000 --interval 5 -o early.geojson --force-crs "
      "--stats "
      "stats.json && "
      "spillway contour t_*.las -q --no-trust-headers --interval 5 -o late.geojson --force-crs");
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
  halve_box();
  const Result again = work_.run(
      "spillway contour t_*.las --tile-points 2000 --interval 5 -o again.geojson --force-crs");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(times(kFalse, again.err), 1);
  EXPECT_EQ(times("written as they are", again.err), 1);
  EXPECT_EQ(lines("again.geojson"), lines("late.geojson"));
}

}  // namespace
}  // namespace spillway::test

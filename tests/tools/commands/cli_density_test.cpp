// Densities by the command, and what it says of periodic boxes.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(DensityCommand, TellsTheMassAndTheVolume) {
  const Workspace work;
  work.succeed("spillway generate -q uniform -n 1000 --dim 3 -o in.npy");
  const auto result = work.run(
      "spillway density in.npy --dim 3 --periodic 0,0,0,1,1,1 -o density.vtu --stats run.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("1000 points, 0 equal ones left out, mass 1000"),
                                HasSubstr("volume 1,")));
  EXPECT_THAT(work.read("run.json"), HasSubstr("\"simplices\""));
  EXPECT_THAT(work.read("density.vtu").substr(0, 2000), HasSubstr("density"));
}

TEST(DensityCommand, TakesAPipeAndWeights) {
  const Workspace work;
  work.write("in.csv", "x,y,mass\n0,0,2\n1,0,2\n0,1,3\n1,1,1\n0.4,0.6,4\n");
  const auto result =
      work.run("cat in.csv | spillway density - --input-format text --weight mass -o out.npy");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("mass 12"), HasSubstr("area 1,")));
}

TEST(DensityCommand, AGridOfThePlaneIsARaster) {
  const Workspace work;
  work.succeed("spillway generate -q haloes -n 2000 --dim 2 -o in.npy");
  work.succeed("spillway density -q in.npy --periodic 0,0,1,1 --grid 50,50 -o density.tif");
  const auto listed = work.run("gdalinfo -stats density.tif");
  EXPECT_THAT(listed.out,
              AllOf(HasSubstr("Size is 50, 50"), HasSubstr("STATISTICS_VALID_PERCENT=100")));
  work.succeed("spillway density -q in.npy --grid 60,40 -o open.tif");
  EXPECT_THAT(work.run("gdalinfo open.tif").out, HasSubstr("Size is 60, 40"));
}

TEST(DensityCommand, RefusesWhatHasNoEffectOrNoMeaning) {
  const Workspace work;
  work.succeed("spillway generate -q uniform -n 100 -o in.npy");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"density in.npy -o d.npy --max-edge 1", "--max-edge"},
      {"density in.npy -o d.npy --heights mean", "--heights"},
      {"density in.npy -o d.npy --resume state", "--resume"},
      {"density in.npy -o d.npy --grid 5", "is not a grid of 2 or 3 axes"},
      {"density in.npy -o d.npy --grid 5,5,5", "--grid has 3 axes"},
      {"density in.npy -o d.npy --grid 5,0", "is not a grid"},
      {"density in.npy -o d.npy --grid-box 0,0,1,1", "no effect without --grid"},
      {"density in.npy -o d.png", "npy or a mesh"},
      {"density in.npy -o d.npy --weight mass", "mass"},
      {"triangulate in.npy -o m.spm --periodic 0,0,1", "is not a periodic box"},
      {"triangulate in.npy -o m.spm --periodic 0,0,0,1,1,1", "has 6 sides"},
      {"triangulate in.npy -o m.spm --periodic 1,0,0,1", "no length along x"},
      {"triangulate in.npy -o m.spm --periodic=-,-,-,-", "no periodic axis"},
      {"triangulate in.npy -o m.spm --periodic 0,0,1,1 --max-edge 1", "longest edge"},
      {"triangulate in.npy -o m.ply --periodic 0,0,1,1", "choose spm, vtu or npy"},
      {"triangulate in.npy -o m.spm --dim 4 --periodic 0,0,1,1", "--dim 2 and 3 only"}};
  for (const auto& [arguments, says] : cases) {
    const auto result = work.run("spillway " + arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    EXPECT_THAT(result.err, HasSubstr(says)) << arguments;
    EXPECT_FALSE(work.has("d.npy") || work.has("m.spm") || work.has("m.ply")) << arguments;
  }
}

TEST(PeriodicCommand, CountsWhatItBringsIntoTheBox) {
  const Workspace work;
  work.succeed("spillway generate -q uniform -n 500 -o in.npy");
  const auto result = work.run("spillway triangulate in.npy --periodic 0,0.5,1,1.5 -o m.spm -v");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("of them brought into the periodic box"),
                                HasSubstr("1000 triangles"), HasSubstr("a margin of")));
  work.succeed("spillway check -q m.spm --points in.npy");
}

TEST(PeriodicCommand, GoesThroughPipes) {
  const Workspace work;
  work.succeed(
      "spillway generate -q uniform -n 5000 --dim 3 | spillway triangulate -q - --dim 3 --periodic "
      "0,0,0,1,1,1 -o - > pipe.spm");
  work.succeed("spillway generate -q uniform -n 5000 --dim 3 -o in.spp");
  work.succeed("spillway triangulate -q in.spp --dim 3 --periodic 0,0,0,1,1,1 -o file.spm");
  EXPECT_EQ(work.info("pipe.spm")["canonical_hash"], work.info("file.spm")["canonical_hash"]);
  work.succeed("spillway check -q pipe.spm");
}

TEST(PeriodicCommand, StaysWithinItsMemoryOutOfCore) {
  const Workspace work;
  work.succeed("spillway generate -q uniform -n 300000 --dim 3 -o in.npy");
  work.succeed(
      "spillway triangulate -q in.npy --dim 3 --periodic 0,0,0,1,1,1 --memory 96M -o m.spm --stats "
      "run.json");
  work.succeed("spillway check -q m.spm");
  EXPECT_THAT(work.read("run.json"), HasSubstr("\"spilled_points\""));
}

}  // namespace
}  // namespace spillway::test

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"
#include "tests/tools/inputs/halved_box.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// A square of side 10 on which a pyramid of height 3 stands.
constexpr const char* kHeap = "0 0 5\n10 0 5\n0 10 5\n10 10 5\n5 5 8\n";
constexpr const char* kGround = "0 0 5\n10 0 5\n0 10 5\n10 10 5\n3 4 5\n";

class VolumeCommand : public ::testing::Test {
 protected:
  VolumeCommand() {
    space.write("heap.xyz", kHeap);
    space.write("ground.xyz", kGround);
  }

  nlohmann::json measure(const std::string& arguments) {
    return nlohmann::json::parse(space.succeed("spillway volume --json " + arguments));
  }

  Workspace space;
};

TEST_F(VolumeCommand, MeasuresAHeapAboveTheGround) {
  const auto volume = measure("heap.xyz ground.xyz");
  EXPECT_NEAR(volume["cut"], 100, 1e-9);  // a third of 100 times 3
  EXPECT_NEAR(volume["net"], 100, 1e-9);
  EXPECT_NEAR(volume["fill"], 0, 1e-9);
  EXPECT_NEAR(volume["cut_area"], 100, 1e-9);
  EXPECT_NEAR(volume["area"], 100, 1e-9);
  const auto turned = measure("ground.xyz heap.xyz");
  EXPECT_EQ(turned["fill"], volume["cut"]);
}

TEST_F(VolumeCommand, MeasuresAboveALevel) {
  const auto volume = measure("heap.xyz --level 6.5");
  EXPECT_NEAR(volume["cut"], 12.5, 1e-9);  // half as high: an eighth
  EXPECT_NEAR(volume["cut_area"], 25, 1e-9);
  EXPECT_NEAR(volume["fill"], 100 * 1.5 - 100 + 12.5, 1e-9);
  EXPECT_EQ(measure("heap.xyz --level 0 --z-factor 2")["cut"], 1200);
}

TEST_F(VolumeCommand, PrintsWhatEachFigureIs) {
  const std::string text = space.succeed("spillway volume heap.xyz ground.xyz");
  EXPECT_THAT(text,
              HasSubstr("cut                     100.000  volume above the second surface\n"));
  EXPECT_THAT(text, HasSubstr("net                     100.000  cut less fill\n"));
  EXPECT_THAT(space.succeed("spillway volume heap.xyz --level 5"),
              HasSubstr("volume above the level 5\n"));
}

TEST_F(VolumeCommand, TakesPointsMeshesAndPipes) {
  space.succeed(
      "spillway triangulate heap.xyz -o heap.spm && spillway triangulate ground.xyz -o g.ply");
  const auto volume = measure("heap.xyz ground.xyz");
  EXPECT_EQ(measure("heap.spm g.ply"), volume);
  EXPECT_EQ(measure("- ground.xyz < heap.spm"), volume);
  EXPECT_EQ(measure("heap.xyz - < ground.xyz"), volume);
}

TEST_F(VolumeCommand, IsTheSameForAllThreadsAndMemories) {
  space.succeed(
      "spillway generate terrain -n 60000 --seed 1 -o a.las && "
      "spillway generate terrain -n 50000 --seed 2 -o b.las");
  const std::string expected = measure("a.las b.las --threads 1 --memory 2G").dump();
  EXPECT_EQ(measure("a.las b.las --threads 2 --memory 64M --leaf-points 700").dump(), expected);
  const auto level = measure("a.las --level 400 --threads 1");
  EXPECT_EQ(measure("a.las --level 400 --threads 2 --memory 64M --leaf-points 700"), level);
  EXPECT_GT(level["fill"], 0);
}

TEST_F(VolumeCommand, WarnsWhereSurfacesDoNotCoverEachOther) {
  space.write("beside.xyz", "20 0 1\n30 0 1\n20 10 1\n");
  space.write("part.xyz", "0 0 1\n5 0 1\n0 10 1\n5 10 1\n");
  const Result beside = space.run("spillway volume heap.xyz beside.xyz");
  EXPECT_THAT(beside.err, HasSubstr("no area in common"));
  const Result part = space.run("spillway volume heap.xyz part.xyz");
  EXPECT_THAT(part.err, HasSubstr("up to 50.0% of a surface"));
}

TEST_F(VolumeCommand, WritesStatistics) {
  space.succeed("spillway volume heap.xyz ground.xyz --stats stats.json");
  const auto stats = nlohmann::json::parse(space.read("stats.json"));
  EXPECT_EQ(stats["simplices"], 4);
  EXPECT_EQ(stats["second"]["simplices"], 4);
  EXPECT_NEAR(stats["volume"]["cut"], 100, 1e-9);
}

TEST_F(VolumeCommand, RefusesWhatCannotBe) {
  struct Refusal {
    const char* arguments;
    const char* message;
  };
  const Refusal refusals[] = {
      {"heap.xyz", "Give a second one, or --level"},
      {"heap.xyz ground.xyz --level 3", "leave one of them out"},
      {"heap.xyz ground.xyz heap.xyz", "between two surfaces"},
      {"- -", "not both"},
      {"heap.xyz ground.xyz --resume folder", "--resume has no effect with two surfaces"},
      {"heap.xyz --level high", "--level"},
  };
  for (const auto& [arguments, message] : refusals) {
    const Result result = space.run(std::string("spillway volume ") + arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments << result.err;
    EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(result.out, "");
  }
  space.write("flat.xy", "0 0\n1 0\n0 1\n");
  EXPECT_THAT(space.run("spillway volume flat.xy heap.xyz").err, HasSubstr("z"));
  EXPECT_EQ(space.run("spillway volume none.las heap.xyz").exit_code, 1);
}

TEST_F(VolumeCommand, ScalesHeightsOfBothSurfacesAlike) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  space.succeed(
      "spillway convert heap.xyz -o heap.las --scale 0.01 --crs EPSG:32632+8228");  // feet
  space.succeed("spillway convert ground.xyz -o ground.las --scale 0.01 --crs EPSG:32632+8228");
  const auto both = measure("heap.las ground.las");
  EXPECT_NEAR(both["cut"], 30.48, 1e-6);
  EXPECT_EQ(measure("heap.las ground.xyz"), both);
  const Result second = space.run("spillway volume heap.xyz ground.las");
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_THAT(second.err, HasSubstr("--z-factor"));
}

TEST_F(VolumeCommand, ReadsAgainWhereHeadersAreFalse) {
  space.succeed("spillway generate terrain -n 40000 -q --grid 7x7 -o 't_#.las'");
  const auto level = measure("'t_*.las' --level 400 --memory 64M");
  const auto between = measure("'t_*.las' ground.xyz --memory 64M");
  const std::vector<std::string> names = space.names();
  halve_box(space, *std::ranges::find_if(
                       names, [](const std::string& name) { return name.starts_with("t_"); }));
  EXPECT_EQ(measure("'t_*.las' --level 400 --memory 64M"), level);
  EXPECT_EQ(measure("'t_*.las' ground.xyz --memory 64M"), between);
}

TEST_F(VolumeCommand, RefusesDegreesAndOtherCoordinateSystems) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Result degrees = space.run("spillway volume heap.xyz --level 5 --crs EPSG:4326");
  EXPECT_EQ(degrees.exit_code, 1);
  EXPECT_THAT(degrees.err, HasSubstr("longitude and latitude are no lengths"));
  space.succeed("spillway convert heap.xyz -o a.las --scale 0.01 --crs EPSG:25832");
  space.succeed("spillway convert ground.xyz -o b.las --scale 0.01 --crs EPSG:25833");
  const Result two = space.run("spillway volume a.las b.las");
  EXPECT_EQ(two.exit_code, 1);
  EXPECT_THAT(two.err, HasSubstr("--force-crs"));
}

}  // namespace
}  // namespace spillway::test

// What --progress json says of every phase of every subcommand, against the statistics of the run.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"
#include "tests/tools/report/progress_lines.h"

namespace spillway::test {
namespace {

using Phases = std::vector<EndedPhase>;

class ProgressOfTheCommand : public ::testing::Test {
 protected:
  /// The phases of one run that must succeed.
  [[nodiscard]] Phases phases(const std::string& arguments) const {
    return phases_of_script(fmt::format("spillway {} --progress json", arguments));
  }

  [[nodiscard]] Phases phases_of_script(const std::string& script) const {
    SCOPED_TRACE(script);
    const Result result = work_.run(script);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return ended_phases(result.err);
  }

  [[nodiscard]] nlohmann::json stats() const {
    return nlohmann::json::parse(work_.read("run.json"));
  }

  /// A number of the stats, by its path.
  [[nodiscard]] std::uint64_t figure(const std::string& path) const {
    return stats().at(nlohmann::json::json_pointer(path)).get<std::uint64_t>();
  }

  Workspace work_;
};

TEST_F(ProgressOfTheCommand, TriangulateEndsItsPhasesWithTheTotals) {
  work_.succeed(
      "spillway generate -q terrain -n 212550 -o in.las\n"
      "spillway generate -q uniform --dim 3 -n 9000 -o space.npy\n"
      "spillway convert -q in.las -o in.txt");
  for (const std::string arguments :
       {"in.las -o a.spm", "in.txt -o a.ply", "in.las in.txt -o a.spm",
        "space.npy --dim 3 -o a.spm", "in.las --every 3 -o a.spm",
        "in.las --thin 3 --bounds 500000,4100000,500200,4100200 -o a.vtu",
        "in.las --max-edge 2 -o a.spm", "in.las --tile-points 5000 --memory 32M -o a.sma"}) {
    SCOPED_TRACE(arguments);
    const Phases all = phases("triangulate --stats run.json " + arguments);
    const char* const simplices = figure("/dimension") == 2 ? "triangles" : "tetrahedra";
    EXPECT_EQ(all, (Phases{{"read", figure("/filters/read"), "points"},
                           {"triangulate", figure("/filters/kept"), "points"},
                           {"write", figure("/simplices"), simplices}}));
  }
}

TEST_F(ProgressOfTheCommand, PointsThatAreWithheldAreReadToo) {
  const auto file = shared_file("hexbin-crop.las");
  if (file.empty()) GTEST_SKIP() << "no shared data";
  const Phases all = phases(
      fmt::format("triangulate --stats run.json --keep-class 2 -o a.spm '{}'", file.string()));
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].done, figure("/filters/read"));
  EXPECT_EQ(all[1].done, figure("/points"));
}

TEST_F(ProgressOfTheCommand, TilesThatAreDividedAgainAreAPhase) {
  const Phases all = phases_of_script(
      "spillway generate -q normal -n 1200000 | spillway triangulate - --memory 32M --tile-points "
      "20000 "
      "-o a.spm --stats run.json --progress json");
  ASSERT_GT(figure("/divided_points"), 0U);
  EXPECT_EQ(all, (Phases{{"read", 1200000, "points"},
                         {"divide", figure("/divided_points"), "points"},
                         {"triangulate", 1200000, "points"},
                         {"write", figure("/simplices"), "triangles"}}));
  EXPECT_GT(stats()["phases"]["divide"], 0);
}

TEST_F(ProgressOfTheCommand, ThinningOutOfCoreIsAPhaseWithinTheOneThatReads) {
  // Each point has a cell of its own, so what found no room is put aside.
  work_.succeed("spillway generate -q utm -n 400000 -o in.spp");
  const auto expect_thin = [](const Phases& all, const std::string& outer) {
    ASSERT_GE(all.size(), 2U);
    EXPECT_EQ(all[0].name, "thin");
    EXPECT_EQ(all[0].unit, "points");
    EXPECT_GT(all[0].done, 100000U);
    EXPECT_LT(all[0].done, 400000U);
    EXPECT_EQ(all[1], (EndedPhase{outer, 400000, "points"}));
  };
  const std::string thin = " in.spp --thin 1e-5 --memory 32M";
  expect_thin(phases("triangulate -o a.spm" + thin), "read");
  expect_thin(phases("info" + thin), "read");
  expect_thin(phases("convert -o a.txt" + thin), "convert");
}

TEST_F(ProgressOfTheCommand, TerrainIsReadAndDrawnInPhases) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  work_.succeed(
      "spillway generate -q terrain -n 5000 -o in.las\n"
      "spillway triangulate -q in.las -o in.spm\n"
      "spillway triangulate -q in.las -o in.ply");
  const auto mesh = work_.info("in.spm");
  const EndedPhase extent{"extent", mesh["vertices"], "vertices"};
  const EndedPhase whole{"read mesh", mesh["simplices"], "simplices"};
  const EndedPhase triangles{"triangles", mesh["simplices"], "triangles"};
  const std::uint64_t copied = std::filesystem::file_size(work_.folder() / "in.spm");
  const Phases of_points = {{"read", 5000, "points"}, {"triangulate", 5000, "points"}};
  struct Input {
    std::string name;
    Phases phases;
  };
  for (const auto& [name, before] :
       {Input{"in.las", of_points}, Input{"in.spm", {extent, triangles}},
        Input{"in.ply", {whole, triangles}},
        Input{"- < in.spm", {{"copy", copied, "bytes"}, extent, triangles}}}) {
    Phases expected = before;
    const Phases dem = phases("dem --stats run.json --resolution 2 -o a.tif " + name);
    expected.push_back({"write", figure("/raster/columns") * figure("/raster/rows"), "pixels"});
    EXPECT_EQ(dem, expected) << name;
    const Phases render = phases("render --stats run.json --size 200 -o a.png " + name);
    expected.back() = {"draw", figure("/picture/columns") * figure("/picture/rows"), "pixels"};
    EXPECT_EQ(render, expected) << name;
    if (name != "- < in.spm") {
      std::erase(expected, extent);
      const Phases contour =
          phases("contour --stats run.json --interval 5 --force-crs -o a.geojson " + name);
      expected.back() = {"write", figure("/contours/lines"), "lines"};
      EXPECT_EQ(contour, expected) << name;
    }
  }
}

TEST_F(ProgressOfTheCommand, TetrahedraAreDrawnInPhases) {
  work_.succeed(
      "spillway generate -q uniform --dim 3 -n 2000 -o in.npy\n"
      "spillway triangulate -q in.npy --dim 3 -o in.spm\n"
      "spillway triangulate -q in.npy --dim 3 -o in.vtu");
  const std::uint64_t simplices = work_.info("in.spm")["simplices"];
  const EndedPhase tetrahedra{"tetrahedra", simplices, "tetrahedra"};
  const Phases stream = phases("render in.spm --size 100 -o a.png --stats run.json");
  const EndedPhase draw{"draw", figure("/picture/columns") * figure("/picture/rows"), "pixels"};
  EXPECT_EQ(stream, (Phases{tetrahedra, draw}));
  EXPECT_EQ(phases("render in.vtu --size 100 -o a.png"),
            (Phases{{"read mesh", simplices, "simplices"}, tetrahedra, draw}));
}

TEST_F(ProgressOfTheCommand, InfoReadsPointsSimplicesOrVertices) {
  work_.succeed(
      "spillway generate -q terrain -n 5000 -o in.las\n"
      "spillway triangulate -q in.las -o in.spm\n"
      "spillway triangulate -q in.las -o in.ply");
  const auto mesh = work_.info("in.spm");
  EXPECT_EQ(phases("info in.las in.spm in.ply --every 7"),
            (Phases{{"read", 5000, "points"},
                    {"read", mesh["simplices"], "simplices"},
                    {"read", mesh["vertices"], "vertices"}}));
}

TEST_F(ProgressOfTheCommand, CheckComparesVerticesAndPointsThatAreKept) {
  work_.succeed(
      "spillway generate -q terrain -n 60000 -o in.las\n"
      "spillway triangulate -q in.las -o in.spm --thin 1\n"
      "spillway triangulate -q in.las -o in.ply --thin 1");
  const auto mesh = work_.info("in.spm");
  const std::uint64_t simplices = mesh["simplices"];
  const std::uint64_t compared = 2 * mesh["vertices"].get<std::uint64_t>();
  const EndedPhase check{"check", simplices, "simplices"};
  const EndedPhase read{"read points", 60000, "points"};
  const EndedPhase compare{"compare", compared, "points"};
  EXPECT_EQ(phases("check in.spm --points in.las --thin 1"), (Phases{check, read, compare}));
  EXPECT_EQ(phases("check in.ply --points in.las --thin 1"),
            (Phases{{"read mesh", simplices, "simplices"}, check, read, compare}));
  const Phases little = phases("check in.spm --points in.las --thin 1 --memory 200K");
  ASSERT_EQ(little.size(), 5U);
  EXPECT_EQ(little[1].name, "thin");
  EXPECT_EQ(little[2], read);
  EXPECT_EQ(little[3].name, "divide");
  EXPECT_GT(little[3].done, 0U);
  EXPECT_EQ(little[4], compare);
}

TEST_F(ProgressOfTheCommand, ConvertCountsWhatIsRead) {
  work_.succeed(
      "spillway generate -q terrain -n 5000 -o in.las\n"
      "spillway triangulate -q in.las -o in.spm\n"
      "spillway triangulate -q in.las -o in.ply\n"
      "spillway triangulate -q in.las -o in.sma");
  for (const std::string arguments :
       {"in.las -o a.txt", "in.las -o a.spp --thin 5", "in.las -o a.las --every 4 --scale 0.5"}) {
    EXPECT_EQ(phases("convert " + arguments), (Phases{{"convert", 5000, "points"}})) << arguments;
  }
  const std::uint64_t simplices = work_.info("in.spm")["simplices"];
  for (const char* name : {"in.spm", "in.sma", "in.ply"}) {
    EXPECT_EQ(phases(fmt::format("convert {} -o a.obj", name)),
              (Phases{{"convert", simplices, "simplices"}}))
        << name;
  }
}

TEST_F(ProgressOfTheCommand, GenerateAndBatchCountTheirWork) {
  for (const std::uint64_t count : {0, 5, 70000}) {
    EXPECT_EQ(phases(fmt::format("generate terrain -n {} -o a.las", count)),
              (Phases{{"generate", count, "points"}}));
  }
  work_.succeed("cp a.las b.las");
  const std::string batch = "batch a.las b.las --to spm --output-dir out --resume";
  const Phases expected = {{"batch", 2, "jobs"}};
  EXPECT_EQ(phases(batch), expected);
  EXPECT_EQ(phases(batch), expected) << "all jobs are unchanged";
}

TEST_F(ProgressOfTheCommand, GrowsWhileAPipeIsRead) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  work_.succeed(
      "spillway generate -q terrain -n 200000 -o in.las\n"
      "spillway convert -q in.las -o in.txt\n"
      "spillway triangulate -q in.las -o in.spm");
  // A line comes each second: half of the input is held back as long.
  const std::string slowly =
      "slowly() {\n"
      "  half=$(($(wc -c < \"$1\") / 2))\n"
      "  head -c $half \"$1\"; sleep 1.3; tail -c +$((half + 1)) \"$1\"\n"
      "}\n";
  std::string script = slowly;
  const std::vector<std::string> runs = {"in.las triangulate - -o 0.spm",
                                         "in.txt triangulate - --thin 2 -o 1.spm",
                                         "in.las info -",
                                         "in.spm info -",
                                         "in.las convert - -o 2.txt",
                                         "in.spm convert - -o 3.ply",
                                         "in.spm check -",
                                         "in.txt check in.spm --any-delaunay --points -",
                                         "in.spm dem - --resolution 5 -o 4.tif"};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::size_t blank = runs[i].find(' ');
    script += fmt::format("slowly {} | spillway {} --progress json > /dev/null 2> {}.json &\n",
                          runs[i].substr(0, blank), runs[i].substr(blank + 1), i);
  }
  work_.succeed(script + "wait");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    SCOPED_TRACE(runs[i]);
    const Phases all = ended_phases(work_.read(fmt::format("{}.json", i)));
    ASSERT_FALSE(all.empty());
    std::size_t lines = 0;
    for (const EndedPhase& phase : all) lines = std::max(lines, phase.lines);
    EXPECT_GT(lines, 1U);
  }
}

}  // namespace
}  // namespace spillway::test

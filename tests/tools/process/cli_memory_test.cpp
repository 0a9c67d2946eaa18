// What the process holds at most: --memory and what docs/cli.md says that it takes beside it, at
// the least limit too, where that counts most.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <string>
#include <tuple>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

constexpr double kMiB = 1 << 20;
/// What a process may hold beside its limit, in MiB.
constexpr double kBeside = 14;

class ResidentMemory : public ::testing::Test {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer's own memory is not in the budget";
#endif
  }

  void generate(const std::string& points) const {
    work_.succeed("spillway generate -q terrain -n " + points);
  }

  /// The statistics of a run on two threads.
  [[nodiscard]] nlohmann::json triangulate(const std::string& arguments,
                                           const std::string& before = "") const {
    work_.succeed(before +
                  "spillway triangulate -q --threads 2 --scratch-folder . --stats stats.json " +
                  arguments);
    return nlohmann::json::parse(work_.read("stats.json"));
  }

  /// In MiB.
  static double peak(const nlohmann::json& stats) {
    return stats["peak_rss_bytes"].get<double>() / kMiB;
  }

  /// What `convert -v` says of it, in MiB.
  [[nodiscard]] double peak_of_conversion(const std::string& script) const {
    const std::string label = "peak memory ";
    const Result result = work_.run(script);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::size_t at = result.err.find(label);
    if (at == std::string::npos) {
      ADD_FAILURE() << result.err;
      return 0;
    }
    return std::stod(result.err.substr(at + label.size())) / kMiB;
  }

  Workspace work_;
};

TEST_F(ResidentMemory, IsTheLimitWhetherAMeshIsAStreamOrSpooled) {
  generate("2000000 -o in.las");
  const auto stream = triangulate("--memory 64M in.las -o mesh.spm");
  const auto spooled = triangulate("--memory 64M in.las -o mesh.ply");
  for (const auto& stats : {stream, spooled}) {
    EXPECT_GT(stats["spilled_points"], 0);
    EXPECT_LE(peak(stats), 64 + kBeside) << stats["output"];
  }
  EXPECT_EQ(spooled["spilled_bytes"], stream["spilled_bytes"]) << "the spool is none of it";
  EXPECT_EQ(work_.info("mesh.ply")["canonical_hash"], stream["canonical_hash"]);
}

TEST_F(ResidentMemory, IsTheLeastLimitWhateverIsWritten) {
  generate("2000000 -o in.las");
  for (const std::string output : {"mesh.ply", "mesh.spm --tasks tasks.jsonl"}) {
    const auto stats = triangulate("--memory 32M in.las -o " + output);
    EXPECT_GT(stats["spilled_points"], 0);
    EXPECT_LE(peak(stats), 32 + kBeside) << output;
  }
}

TEST_F(ResidentMemory, IsTheLimitWhereMorePointsMakeMoreAndMoreSimplices) {
  for (const std::string points : {"lines -n 6000", "lines -n 60000", "circle -n 200000"}) {
    work_.succeed("spillway generate -q --dim 3 -o in.spp " + points);
    const Result refused =
        work_.run("spillway triangulate -q --dim 3 --threads 2 --memory 96M in.spp -o mesh.spm");
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.err, HasSubstr("of memory are too little for"));
    rusage most{};  // of the processes so far
    ASSERT_EQ(getrusage(RUSAGE_CHILDREN, &most), 0);
    EXPECT_LE(static_cast<double>(most.ru_maxrss) / 1024, 96 + kBeside) << points;
  }
}

TEST_F(ResidentMemory, IsEnoughForCurvesAndSurfacesWhoseBordersAreSmall) {
  for (const auto& [points, dimension, memory] :
       {std::tuple{"ellipsoid -n 300000", 2, 32}, std::tuple{"ellipsoid -n 150000", 3, 96},
        std::tuple{"scan -n 400000", 3, 96}}) {
    work_.succeed(fmt::format("spillway generate -q --dim {} -o in.spp {}", dimension, points));
    const auto stats =
        triangulate(fmt::format("--dim {} --memory {}M in.spp -o mesh.spm", dimension, memory));
    EXPECT_LE(peak(stats), memory + kBeside) << points;
    work_.succeed("spillway check -q mesh.spm");
  }
}

TEST_F(ResidentMemory, IsTheLeastLimitOfAPipeAndWhatAnEmptyRunTakes) {
  constexpr double kBesidePipes = 12;  // MiB
  work_.write("three.txt", "0 0 1\n1 0 2\n0 1 3\n");
  EXPECT_LE(peak(triangulate("--memory 32M - -o mesh.spm < three.txt")), kBeside);
  for (const std::string family : {"terrain", "uniform"}) {
    const std::string source = fmt::format("spillway generate -q {} -n 2e6 | ", family);
    const auto stats = triangulate("--memory 32M - -o mesh.spm", source);
    EXPECT_GT(stats["spilled_points"], 0) << family;
    EXPECT_LE(peak(stats), 32 + kBesidePipes) << family;
  }
  const std::string equal =
      "awk 'BEGIN {for (i = 0; i < 1500000; ++i) print 5, 7, i % 1000; print \"0 0 0\\n9 0 1\"}' "
      "| ";
  const auto stats = triangulate("--memory 32M --heights highest - -o mesh.obj", equal);
  EXPECT_GT(stats["spilled_points"], 0);
  EXPECT_EQ(stats["duplicates"], 1'499'999);
  EXPECT_LE(peak(stats), 32 + kBesidePipes);
  EXPECT_THAT(work_.read("mesh.obj"), HasSubstr("v 5 7 999\n"));
}

TEST_F(ResidentMemory, IsTheLeastLimitWhereTilesAreTriangulatedWhilePointsAreRead) {
  generate("2000000 --grid 4x4 -o 't_#.las'");
  const auto survey = triangulate("--memory 32M t_*.las -o mesh.spm");
  EXPECT_LT(survey["first_block_read_points"], survey["points"].get<int>() / 2);
  EXPECT_LE(peak(survey), 32 + kBeside);

  work_.succeed(
      "spillway convert -q t_*.las --sorted --memory 32M --scratch-folder . -o sorted.spp");
  const auto pipe = triangulate("--memory 32M - -o mesh.spm", "cat sorted.spp | ");
  EXPECT_LT(pipe["first_block_read_points"], pipe["points"].get<int>() / 2);
  EXPECT_LE(peak(pipe), 32 + kBeside);
  EXPECT_EQ(pipe["canonical_hash"], survey["canonical_hash"]);
}

TEST_F(ResidentMemory, IsTheLeastLimitOfManyFilesWithLongTextsAndOfManyCells) {
  work_.write("wkt", "LOCAL_CS[\"" + std::string(60'000, 'x') + "\"]");
  work_.succeed("spillway generate -q lattice -n 200 -o in.spp");
  work_.succeed("spillway convert -q --crs wkt in.spp -o 0.las --las-version 1.4");
  std::string inputs;
  for (int i = 0; i < 1000; ++i) inputs += "0.las\n";
  work_.write("list", inputs);
  const auto files = triangulate("--memory 32M @list -o mesh.spm");
  EXPECT_EQ(files["points"], 200'000);
  EXPECT_LE(peak(files), 32 + kBeside);

  generate("300000 -o in.las");
  work_.succeed("spillway convert -q in.las --sorted --cell-points 2 --memory 2G -o cells.spp");
  const auto cells = triangulate("--memory 32M cells.spp -o mesh.spm");
  EXPECT_LE(peak(cells), 32 + kBeside);
}

TEST_F(ResidentMemory, IsTheLeastLimitWherePointsAreSorted) {
  generate("3000000 -o in.spp");
  const std::string sort = "spillway convert -v --sorted --memory 32M --scratch-folder . ";
  for (const std::string input : {"in.spp", "- < in.spp"}) {
    const std::string command = fmt::format("{}-o sorted.spp {}", sort, input);
    EXPECT_LE(peak_of_conversion(command), 32 + kBeside) << input;
  }
  const std::string pipe = "spillway generate -q uniform -n 2e6 | " + sort + "- -o - > sorted.spp";
  EXPECT_LE(peak_of_conversion(pipe), 32 + kBeside);
}

/// However many points are in one pixel, and however small pixels are.
TEST_F(ResidentMemory, IsTheLimitForRastersOfPointsBesideGdal) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  constexpr double kOfGdal = 40;
  generate("3000000 -o in.las");
  for (const std::string products : {"count,p50,stddev", "count,p50,stddev,height --fill-voids"}) {
    for (const std::string resolution : {"10000", "0.4"}) {
      work_.succeed(
          "spillway dem -q in.las -o a.tif --memory 64M --threads 2 --scratch-folder . "
          "--stats stats.json --resolution " +
          resolution + " --product " + products);
      const auto stats = nlohmann::json::parse(work_.read("stats.json"));
      EXPECT_LE(peak(stats), 64 + kBeside + kOfGdal) << products << ", " << resolution;
      EXPECT_GT(stats["raster"]["spilled_bytes"], 0);
      EXPECT_EQ(stats["raster"]["points_in_pixels"], 3'000'000);
    }
  }
}

}  // namespace
}  // namespace spillway::test

// Mesh streams through `check` and `info`, from files and pipes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

TEST(CliStream, CheckProvesStreamsOfEveryKind) {
  const Workspace work;
  for (const std::string generate :
       {"terrain -n 5000 -o in.las", "lattice -n 2000 -o in.las", "uniform -n 2000 -o in.npy",
        "uniform -n 700 --dim 3 -o in.npy"}) {
    const std::string dim = generate.find("--dim 3") == std::string::npos ? "2" : "3";
    const std::string in = generate.substr(generate.rfind(' ') + 1);
    work.succeed("spillway generate -q " + generate);
    for (const std::string mesh : {"mesh.spm", "mesh.sma"}) {
      if (mesh == "mesh.sma" && dim == "3") continue;  // it holds triangles
      work.succeed("spillway triangulate -q --dim " + dim + " " + in + " -o " + mesh);
      const auto report = nlohmann::json::parse(
          work.succeed("spillway check -q --json " + mesh + " --points " + in));
      EXPECT_EQ(report["proved"], true) << generate << " " << mesh;
      EXPECT_GT(report["peak_live_vertices"].get<int>(), 0);
      work.succeed("spillway triangulate -q --dim " + dim + " " + in + " -o mesh.ply");
      const auto whole = nlohmann::json::parse(work.succeed("spillway check -q --json mesh.ply"));
      for (const char* key : {"vertices", "simplices", "hull_facets", "canonical_hash"}) {
        EXPECT_EQ(report[key], whole[key]) << key;
      }
    }
  }
}

TEST(CliStream, CheckMissesAPointOfTheInput) {
  const Workspace work;
  work.write("in.txt", "0 0 0\n1 0 0\n0 1 0\n");
  work.write("more.txt", "0.3 0.3 0\n");
  work.succeed("spillway triangulate -q in.txt -o mesh.spm");
  EXPECT_EQ(work.run("spillway check -q mesh.spm --points in.txt").exit_code, 0);
  const Result missing = work.run("spillway check -q mesh.spm --points in.txt more.txt");
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.out, HasSubstr("is no vertex of the mesh"));
}

TEST(CliStream, CheckRefutesATextStreamWithTheWrongDiagonal) {
  const Workspace work;
  const std::string vertices = "v 0 0 0\nv 3 1 0\nv 3 -1 0\nv 6 0 0\n";
  work.write("good.sma", vertices + "f 1 3 2\nf 4 2 3\n");
  work.write("bad.sma", vertices + "f 1 4 2\nf 1 3 4\n");
  EXPECT_EQ(work.run("spillway check -q good.sma").exit_code, 0);
  const Result bad = work.run("spillway check -q bad.sma");
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.out, HasSubstr("is not Delaunay"));
}

TEST(CliStream, CheckRefusesAStreamThatIsCutShort) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 5000 -o in.las\n"
      "spillway triangulate -q in.las -o mesh.spm\n"
      "head -c 20000 mesh.spm > short.spm");
  const Result result = work.run("spillway check -q short.spm");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("spillway: error: short.spm"));
  EXPECT_EQ(work.run("spillway info -q short.spm").exit_code, 1);
}

TEST(CliStream, InfoTellsOfAStreamWhatItTellsOfOtherMeshes) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 5000 -o in.las\n"
      "spillway triangulate -q in.las -o mesh.spm\n"
      "spillway triangulate -q in.las -o mesh.ply\n"
      "cp mesh.spm noname");
  const auto ply = work.info("mesh.ply");
  for (const std::string name : {"mesh.spm", "noname"}) {
    const auto stream = work.info(name);
    EXPECT_EQ(stream["kind"], "mesh");
    EXPECT_EQ(stream["format"], "spm");
    EXPECT_EQ(stream["points"], 5000);
    for (const char* key : {"dimension", "vertices", "simplices", "hull_facets", "canonical_hash",
                            "extent", "scale", "offset", "on_lattice", "input_index", "crs"}) {
      EXPECT_EQ(stream[key], ply[key]) << key;
    }
  }
}

TEST(CliStream, PipesCarryPointsAndMeshStreamsToInfoAndCheck) {
  const Workspace work;
  for (const std::string format : {"spm", "sma"}) {
    const std::string mesh =
        "spillway generate -q terrain -n 3000 -o - | "
        "spillway triangulate -q - -o - --output-format " +
        format + " | ";
    const auto info = nlohmann::json::parse(work.succeed(mesh + "spillway info -q --json -"));
    EXPECT_EQ(info["kind"], "mesh");
    EXPECT_EQ(info["format"], format);
    const auto check = nlohmann::json::parse(work.succeed(mesh + "spillway check -q --json -"));
    EXPECT_EQ(check["proved"], true);
    EXPECT_EQ(check["canonical_hash"], info["canonical_hash"]);
    EXPECT_EQ(check["hull_facets"], info["hull_facets"]);
  }
  const auto points = nlohmann::json::parse(
      work.succeed("spillway generate -q terrain -n 3000 -o - | spillway info -q --json -"));
  EXPECT_EQ(points["kind"], "points");
}

TEST(CliStream, ProgressOfCheckHasAPercentage) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 20000 -o in.las\n"
      "spillway triangulate -q in.las -o mesh.spm");
  const Result result = work.run("spillway check --progress json mesh.spm");
  const std::string last = result.err.substr(result.err.rfind('\n', result.err.size() - 2) + 1);
  const auto state = nlohmann::json::parse(last);
  EXPECT_EQ(state["phase"], "check");
  EXPECT_EQ(state["fraction"], 1);
}

}  // namespace
}  // namespace spillway::test

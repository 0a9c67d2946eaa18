// What the command writes is the same mesh in every format, and `check` proves it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

struct FormatCase {
  std::string name;
  std::string file;
  std::string option;
  bool tetrahedra;
  bool input_index;
};

std::ostream& operator<<(std::ostream& out, const FormatCase& c) { return out << c.name; }

class EveryMeshFormat : public testing::TestWithParam<FormatCase> {};

/// Triangulates to the format and to PLY; both must have one hash, and `check` must prove the
/// first.
void expect_same_mesh_as_ply(const Workspace& work, const FormatCase& format,
                             const std::string& dimension) {
  work.succeed("spillway triangulate -q in.las --dim " + dimension + " -o reference.ply\n" +
               "spillway triangulate -q in.las --dim " + dimension + " -o " + format.file + " " +
               format.option);
  const auto reference = work.info("reference.ply");
  const auto mesh = work.info(format.file);
  for (const char* key : {"vertices", "simplices", "hull_facets", "canonical_hash", "dimension"}) {
    EXPECT_EQ(mesh[key], reference[key]) << key;
  }
  work.succeed("spillway check -q " + format.file + " --points in.las");
}

TEST_P(EveryMeshFormat, HoldsTheTrianglesOfTerrain) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 5000 -o in.las");
  expect_same_mesh_as_ply(work, GetParam(), "2");
}

TEST_P(EveryMeshFormat, HoldsTheTrianglesOfALatticeFullOfTies) {
  const Workspace work;
  work.succeed("spillway generate -q lattice -n 2500 -o in.las");
  expect_same_mesh_as_ply(work, GetParam(), "2");
}

TEST_P(EveryMeshFormat, HoldsTheInputIndexOrRefusesItBeforeAnyWork) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 500 -o in.las");
  const std::string to_format = GetParam().file + " " + GetParam().option;
  if (GetParam().input_index) {
    work.succeed("spillway triangulate -q --id in.las -o " + to_format);
    EXPECT_EQ(work.info(GetParam().file)["input_index"], true);
  } else {
    const Result result = work.run("spillway triangulate -v --id in.las -o " + to_format);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err.find("spillway: error: "), 0U) << result.err;
  }
}

TEST_P(EveryMeshFormat, HoldsTetrahedraOrRefusesThem) {
  const Workspace work;
  work.succeed("spillway generate -q lattice -n 1000 --dim 3 -o in.las");
  if (GetParam().tetrahedra) {
    expect_same_mesh_as_ply(work, GetParam(), "3");
  } else {
    const Result result = work.run("spillway triangulate -q in.las --dim 3 -o " + GetParam().file);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("spillway: error: "), std::string::npos);
    EXPECT_EQ(work.names(), std::vector<std::string>{"in.las"});
  }
}

INSTANTIATE_TEST_SUITE_P(Cli, EveryMeshFormat,
                         testing::Values(FormatCase{"ply", "mesh.ply", "", true, true},
                                         FormatCase{"ply-ascii", "mesh.ply",
                                                    "--output-format ply-ascii", true, true},
                                         FormatCase{"obj", "mesh.obj", "", false, false},
                                         FormatCase{"off", "mesh.off", "", false, false},
                                         FormatCase{"vtu", "mesh.vtu", "", true, true},
                                         FormatCase{"npy", "mesh.npy", "", true, true}));

class EveryPointFormat : public testing::TestWithParam<std::string> {};

TEST_P(EveryPointFormat, GivesTheSameTriangulation) {
  const Workspace work;
  const std::string name = "in." + GetParam();
  work.succeed(
      fmt::format("spillway generate -q terrain -n 5000 -o in.las\n"
                  "spillway generate -q terrain -n 5000 -o {0}\n"
                  "spillway triangulate -q in.las -o reference.ply\n"
                  "spillway triangulate -q {0} -o mesh.ply",
                  name));
  // Off the lattice ties can fall differently, so counts are what must agree.
  EXPECT_EQ(work.info("mesh.ply")["vertices"], work.info("reference.ply")["vertices"]);
  EXPECT_EQ(work.info(name)["points"], 5000);
  EXPECT_EQ(work.info(name)["extent"], work.info("in.las")["extent"]);
  work.succeed("spillway check -q mesh.ply --points " + name);
}

INSTANTIATE_TEST_SUITE_P(Cli, EveryPointFormat, testing::Values("txt", "csv", "npy"));

}  // namespace
}  // namespace spillway::test

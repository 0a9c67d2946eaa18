// What the command writes is the same mesh in every format, and `check` proves it.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

struct FormatCase {
  std::string name;
  std::string file;
  std::string option;
  bool tetrahedra;
  bool input_index;
};

std::ostream& operator<<(std::ostream& out, const FormatCase& c) { return out << c.name; }

class EveryMeshFormat : public ::testing::TestWithParam<FormatCase> {};

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
                         ::testing::Values(FormatCase{"ply", "mesh.ply", "", true, true},
                                           FormatCase{"ply-ascii", "mesh.ply",
                                                      "--output-format ply-ascii", true, true},
                                           FormatCase{"obj", "mesh.obj", "", false, false},
                                           FormatCase{"off", "mesh.off", "", false, false},
                                           FormatCase{"vtu", "mesh.vtu", "", true, true},
                                           FormatCase{"npy", "mesh.npy", "", true, true}));

class EveryPointFormat : public ::testing::TestWithParam<std::string> {};

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

TEST(FirstBytes, GoBeforeNames) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 2000 -o in.las\n"
      "spillway triangulate -q in.las -o truth.spm\n"
      "cp in.las in.txt; cp in.las in.ply; cp in.las in.spm; cp truth.spm truth.txt\n"
      "gzip -c in.las > in.xyz.gz");
  const auto truth = work.info("truth.spm")["canonical_hash"];
  for (const char* const name : {"in.txt", "in.ply", "in.spm"}) {
    EXPECT_EQ(work.info(name)["format"], "las") << name;
    work.succeed(fmt::format("spillway triangulate -q {} -o mesh.spm", name));
    EXPECT_EQ(work.info("mesh.spm")["canonical_hash"], truth) << name;
  }
  EXPECT_EQ(work.info("truth.txt")["canonical_hash"], truth);
  work.succeed("spillway check -q truth.txt --points in.ply");
  EXPECT_THAT(work.run("spillway info in.xyz.gz").err, HasSubstr("only text is read compressed"));
  EXPECT_THAT(work.run("spillway check in.ply").err, HasSubstr("this begins as points in LAS"));
}

TEST(FirstBytes, ALazFileNamedAsText) {
  const std::filesystem::path laz = shared_file("autzen_trim.laz");
  if (laz.empty()) GTEST_SKIP() << "the shared sample files are not there";
  const Workspace work;
  work.succeed("cp '" + laz.string() + "' in.txt");
  EXPECT_EQ(work.info("in.txt")["format"], "laz");
  EXPECT_EQ(work.info("in.txt")["points"], 110000);
}

TEST(TextColumns, WhatIsNotPlainIsTold) {
  const Workspace work;
  work.write("a.csv", "pid,X_UTM,Y_UTM,Elev_m\n1,10,20,30\n2,11,20,31\n3,10,21,32\n");
  work.succeed("cp a.csv b.csv");
  const Result result = work.run("spillway convert a.csv b.csv -o out.csv");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err,
              HasSubstr("a.csv (and 1 more): column 2 (\"X_UTM\") is taken for x, column 3 "
                        "(\"Y_UTM\") is taken for y, column 4 (\"Elev_m\") is taken for z\n"));
  EXPECT_THAT(work.read("out.csv"),
              ::testing::StartsWith("x,y,z,pid\n10,20,30,1\n11,20,31,2\n10,21,32,3\n10,20,"));
  EXPECT_EQ(work.run("spillway convert -q a.csv -o out.csv").err, "");
}

TEST(TextColumns, WhatCannotBeToldLeavesNothing) {
  const Workspace work;
  work.write("a.csv", "1,5,2,5\n");
  work.write("b.csv", "pid,foo,bar\n1,2,3\n");
  for (const std::string name : {"a.csv", "b.csv"}) {
    const Result result = work.run("spillway triangulate " + name + " -o mesh.ply");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("error: " + name + ": line 1 "));
  }
  EXPECT_EQ(work.names(), (std::vector<std::string>{"a.csv", "b.csv"}));
}

TEST(PlyPoints, AreWhatTheOtherFormatsHold) {
  const Workspace work;
  work.write(
      "cloud.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
      "property double z\nproperty uchar red\nend_header\n0 0 0 1\n1 0 0 2\n0 1 0 3\n5 5 1 4\n");
  EXPECT_EQ(work.info("cloud.ply").at("kind"), "points");
  EXPECT_EQ(
      work.succeed("spillway convert -q cloud.ply -o -  --output-format text --attributes all"),
      "x y z red\n0 0 0 1\n1 0 0 2\n0 1 0 3\n5 5 1 4\n");
  EXPECT_EQ(work.succeed("cat cloud.ply | spillway convert -q - -o - --output-format text"),
            "0 0 0\n1 0 0\n0 1 0\n5 5 1\n");
  const Result mesh = work.run("spillway convert cloud.ply -o mesh.obj");
  EXPECT_EQ(mesh.exit_code, 1);
  EXPECT_THAT(mesh.err, HasSubstr("these are points, and mesh.obj would be a mesh"));
}

TEST(PlyPoints, AndMeshesAreToldApartByTheInputInConvert) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 500 -o in.ply\n"
      "spillway triangulate -q in.ply -o mesh.ply\n"
      "spillway convert -q mesh.ply -o again.ply\n"
      "spillway convert -q in.ply -o - --output-format ply | cmp - in.ply\n"
      "spillway convert -q mesh.ply -o - --output-format ply | cmp - again.ply");
  EXPECT_EQ(work.info("in.ply").at("kind"), "points");
  EXPECT_EQ(work.info("again.ply").at("kind"), "mesh");
  EXPECT_THAT(work.run("spillway triangulate mesh.ply -o x.spm").err,
              HasSubstr("this is a mesh (PLY), not points"));
}

TEST(PlyPoints, OfAFolderAreTakenAndMeshesThereAreNot) {
  const Workspace work;
  work.succeed(
      "mkdir folder\n"
      "spillway generate -q terrain -n 500 -o folder/in.ply\n"
      "spillway triangulate -q folder/in.ply -o folder/mesh.ply\n"
      "spillway convert -q folder -o all.xyz --attributes none");
  EXPECT_EQ(work.succeed("wc -l < all.xyz"), "500\n");
}

/// The hash of what the command makes of a file.
std::string hash_of(const Workspace& work, const std::string& file) {
  work.succeed("spillway triangulate -q " + file + " -o mesh.spm");
  return work.info("mesh.spm").at("canonical_hash");
}

TEST(PointsWithAttributes, HaveTheTriangulationOfTheirCoordinates) {
  const Workspace work;
  work.succeed(
      "spillway generate -q uniform -n 2000 -o in.xyz\n"
      "spillway generate -q terrain -n 2000 -o hills.las\n"
      "spillway convert -q hills.las -o hills.npy\n"
      "spillway convert -q hills.las -o hills.ply\n"
      "spillway convert -q in.xyz -o in.npy\n"
      "spillway convert -q in.xyz -o in.ply");
  for (const std::string format : {"npy", "ply"}) {
    EXPECT_EQ(hash_of(work, "in." + format), hash_of(work, "in.xyz")) << format;
    EXPECT_EQ(hash_of(work, "hills." + format), hash_of(work, "hills.las")) << format;
  }
}

TEST(PointsWithAttributes, OfLasComeBackByteByByte) {
  const Workspace work;
  std::string table = "x,y,z,class,intensity,gps_time,red,green,blue,scan_angle,mine\n";
  for (int i = 0; i < 500; ++i) {
    table +=
        fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", i * 0.25, i * i % 97, i % 7, i % 256,
                    i * 131 % 65536, 1e9 + i * 0.001, i, 65535 - i, i * 7, i % 3 * 0.006, -i * 0.1);
  }
  work.write("in.csv", table);
  const std::string lattice = " --scale 0.25,1,1 --offset 0,0,0\n";
  work.succeed("spillway convert -q in.csv -o in.las" + lattice);
  for (const std::string format : {"npy", "ply"}) {
    work.succeed("spillway convert -q in.las -o there." + format + "\nspillway convert -q there." +
                 format + " -o back.las" + lattice + "cmp in.las back.las");
  }
}

bool has_numpy(const Workspace& work) {
  return work.run("/usr/bin/python3 -c 'import numpy'").exit_code == 0;
}
constexpr const char* kNoNumpy = "/usr/bin/python3 has no NumPy";

TEST(NumpyArrays, OfEveryKindAreReadAsTheyAreMeant) {
  const Workspace work;
  if (!has_numpy(work)) GTEST_SKIP() << kNoNumpy;
  work.write("make.py", R"(
import numpy as np
a = np.random.default_rng(5).integers(-100, 100, (300, 5)).astype("f8")
np.savetxt("a.xyz", a[:, :3], fmt="%.17g")
for i, t in enumerate(["f8", "f4", "i8", "i4", "i2", "i1", ">f8", ">f4", ">i8", ">i4", ">i2"]):
    np.save(f"plain{i}.npy", a[:, :3].astype(t))
    np.save(f"columns{i}.npy", np.asfortranarray(a.astype(t)))
    s = np.zeros(300, np.dtype([("c", "u1"), ("Y", t), ("name", "U4"), ("x", ">f8"), ("z", t),
                                ("v", "<u2", (3,)), ("t", "M8[us]")], align=i % 2 == 0))
    s["x"], s["Y"], s["z"] = a[:, :3].T
    np.save(f"fields{i}.npy", s)
)");
  work.succeed(
      "/usr/bin/python3 make.py\n"
      "spillway convert -q a.xyz -o want.npy\n"
      "for f in plain*.npy columns*.npy fields*.npy; do\n"
      "  spillway convert -q $f -o got.npy --attributes none && cmp got.npy want.npy || exit 1\n"
      "done");
}

TEST(NumpyArrays, OfPointsWithAttributesAreStructures) {
  const Workspace work;
  if (!has_numpy(work)) GTEST_SKIP() << kNoNumpy;
  work.write("in.csv", "x,y,class,it's\n1,2,3,0.5\n4,5,6,nan\n");
  work.write("look.py", R"(
import numpy as np
a = np.load("out.npy")
assert a.dtype.names == ("x", "y", "classification", "it's"), a.dtype
assert a.shape == (2,) and list(a["x"]) == [1, 4] and list(a["classification"]) == [3, 6]
)");
  work.succeed(
      "spillway convert -q in.csv -o out.npy && /usr/bin/python3 look.py\n"
      "cat in.csv | spillway convert -q - -o - --output-format npy | cmp - out.npy");
}

/// The layer is called after the file, whose name may be anything.
TEST(VectorNames, MayBeginWithAnySign) {
  if (build_lacks("GDAL")) GTEST_SKIP() << kNoGdal;
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 200 -o in.las");
  for (const char* const name :
       {"a%b", "-x", "%s%n", "a-b", ".x", "--", "a b", "a'b", "a\"b", "?"}) {
    for (const char* const extension : {"gpkg", "shp"}) {
      const std::string file = fmt::format("./{}.{}", name, extension);
      work.write("file", file);
      work.succeed("spillway triangulate -q in.las -o \"$(cat file)\"");
      EXPECT_THAT(work.succeed("spillway info -q --json \"$(cat file)\""),
                  HasSubstr("\"simplices\":382"))
          << file;
      work.succeed("spillway contour -q in.las --interval 5 -o \"$(cat file)\"");
    }
  }
  work.succeed(
      "spillway triangulate -q in.las -o -y.gpkg; spillway convert -q -o z.spm -- -y.gpkg");
}

TEST(VectorNames, AShapefileWithABackslashIsRefused) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 200 -o in.las");
  const Result result = work.run("spillway triangulate -q in.las -o 'a\\b.shp'");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("its path has a backslash"));
  EXPECT_EQ(work.names(), std::vector<std::string>{"in.las"});
}

TEST(EndlessPipes, EndWithAnError) {
  const Workspace work;
  for (const char* const format : {"landxml", "obj", "off", "ply", "vtu", "sma", "stl"}) {
    const Result result =
        work.run(fmt::format("ulimit -t 60; spillway check - --mesh-format {} </dev/zero", format));
    EXPECT_EQ(result.exit_code, 1) << format << result.err;
    EXPECT_THAT(result.err, ::testing::StartsWith("spillway: error: standard input: ")) << format;
  }
}

INSTANTIATE_TEST_SUITE_P(Cli, EveryPointFormat, ::testing::Values("txt", "csv", "npy"));

}  // namespace
}  // namespace spillway::test

// `convert`: every mesh format to every other, streams through pipes, what cannot be held.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

TEST(Convert, KeepsTheMeshWhateverTheFormats) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 3000 -o in.las\n"
      "spillway triangulate -q in.las -o mesh.spm");
  const auto hash = work.info("mesh.spm")["canonical_hash"];
  for (const std::string format : {"ply", "obj", "off", "vtu", "sma", "spm"}) {
    work.succeed(
        fmt::format("spillway convert -q mesh.spm -o there.{0}\n"
                    "spillway check -q there.{0}\n"
                    "spillway convert -q there.{0} -o back.spm\n"
                    "spillway check -q back.spm --points in.las",
                    format));
    EXPECT_EQ(work.info("there." + format)["canonical_hash"], hash) << format;
    EXPECT_EQ(work.info("back.spm")["canonical_hash"], hash) << format;
  }
}

TEST(Convert, KeepsInputIndicesAndTetrahedra) {
  const Workspace work;
  work.succeed(
      "spillway generate -q uniform --dim 3 -n 500 -o in.npy\n"
      "spillway triangulate -q --dim 3 --id in.npy -o mesh.spm\n"
      "spillway triangulate -q --dim 3 --id in.npy -o direct.vtu\n"
      "spillway convert -q mesh.spm -o converted.vtu\n"
      "cmp direct.vtu converted.vtu");
}

TEST(Convert, TellsTheFilesOfAnNpyMeshAndWhatIsRounded) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 500 -o in.las\n"
      "spillway triangulate -q in.las -o mesh.spm");
  EXPECT_THAT(work.run("spillway convert mesh.spm -o t.npy").err,
              HasSubstr("in t_vertices.npy and t_simplices.npy\n"));
  EXPECT_THAT(work.run("spillway convert mesh.spm -o t.glb").err, HasSubstr("32-bit floats"));
  EXPECT_THAT(work.run("spillway triangulate in.las -o t.stl").err, HasSubstr("32-bit floats"));
  EXPECT_THAT(work.run("spillway check t.stl --points in.las").out, HasSubstr("hint: "));
  EXPECT_EQ(work.run("spillway check mesh.spm --points in.las").out.find("hint: "),
            std::string::npos);
}

TEST(Convert, TellsTheOriginOfAnStlThatOtherProgramsDoNotKnow) {
  const Workspace work;
  work.write("far.txt", "500010.25 4100020.5 30\n500011 4100020 31\n500010 4100022 32\n");
  const std::string far = work.run("spillway triangulate far.txt -o far.stl").err;
  EXPECT_THAT(far, ::testing::ContainsRegex("find them without 50001[01], 410002[0-2], 3[0-2], the "
                                            "origin that far.stl names"));
  work.succeed("spillway triangulate -q far.txt -o far.ply");
  EXPECT_THAT(work.run("spillway convert far.ply -o far.stl").err,
              HasSubstr("find them without 5"));
  EXPECT_THAT(work.run("spillway convert far.ply -o far.glb").err,
              ::testing::Not(HasSubstr("find them without")));
  work.write("near.txt", "0.1 0.1 0.1\n0.4 0 0.2\n0 0.4 0.3\n");
  EXPECT_THAT(work.run("spillway triangulate near.txt -o near.stl").err,
              ::testing::Not(HasSubstr("find them without")));
}

TEST(Convert, PassesAStreamThroughAPipe) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 3000 -o in.las\n"
      "spillway triangulate -q in.las -o mesh.ply\n"
      "spillway triangulate -q in.las -o - | spillway convert -q - -o - | "
      "spillway convert -q - -o piped.ply\n"
      "cmp mesh.ply piped.ply");
}

TEST(Convert, RefusesWhatItCannotDoAndLeavesNothing) {
  const Workspace work;
  work.succeed(
      "spillway generate -q uniform --dim 3 -n 100 -o in.npy\n"
      "spillway triangulate -q --dim 3 in.npy -o mesh.spm\n"
      "head -c 1000 mesh.spm > short.spm");
  EXPECT_THAT(work.run("spillway convert -q mesh.spm -o mesh.obj").err,
              HasSubstr("holds no tetrahedra"));
  EXPECT_THAT(work.run("spillway convert -q in.npy -o mesh.obj").err,
              HasSubstr("these are points"));
  EXPECT_EQ(work.run("spillway convert -q short.spm -o mesh.ply").exit_code, 1);
  EXPECT_EQ(work.run("spillway convert -q mesh.spm -o mesh.xyz").exit_code, 2);
  EXPECT_EQ(work.names(), (std::vector<std::string>{"in.npy", "mesh.spm", "short.spm"}));
}

/// A square of two triangles, the first one twice.
constexpr const char* kTwice = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\nf 1 2 3\n";

TEST(Convert, WhatSpmCannotHoldIsRefused) {
  const Workspace work;
  work.write("twice.obj", kTwice);
  work.succeed("spillway convert -q twice.obj -o twice.sma");
  for (const std::string input : {"twice.obj", "twice.sma", "- < twice.sma"}) {
    const Result result = work.run("spillway convert -q -o o.spm " + input);
    EXPECT_EQ(result.exit_code, 1) << input;
    EXPECT_THAT(result.err, HasSubstr("more than two triangles have the edge of the vertices"));
    EXPECT_FALSE(work.has("o.spm"));
  }
  work.succeed("spillway convert -q twice.obj -o twice.ply\nspillway info -q twice.ply");
}

}  // namespace
}  // namespace spillway::test

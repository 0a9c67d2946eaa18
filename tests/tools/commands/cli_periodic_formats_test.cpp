// Periodic meshes in files of several formats, as the command converts, proves and describes them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A case: how points are made, and the box that they repeat with.
struct PeriodicCase {
  std::string points;
  std::string box;
  int dimension;
  bool has_lattice;
};

std::vector<PeriodicCase> cases() {
  return {{"uniform -n 600 --dim 2 -o in.spp", "0,0,1,1", 2, false},
          {"uniform -n 600 --dim 3 -o in.spp", "0,0,0,1,1,1", 3, false},
          {"lattice -n 512 --dim 3 -o in.las", "0,0,-,8,8,-", 3, true}};
}

void triangulate(const Workspace& work, const PeriodicCase& made) {
  work.succeed("spillway generate -q " + made.points);
  work.succeed(fmt::format("spillway triangulate -q {} --dim {} --periodic {} --id -o mesh.spm",
                           made.has_lattice ? "in.las" : "in.spp", made.dimension, made.box));
}

/// What a script says that ends with that exit code.
std::string messages_of(const Workspace& work, const std::string& script, int exit_code) {
  const auto result = work.run(script);
  EXPECT_EQ(result.exit_code, exit_code) << script;
  return result.out + result.err;
}

TEST(PeriodicFormats, KeepTheMesh) {
  for (const PeriodicCase& made : cases()) {
    const Workspace work;
    triangulate(work, made);
    const auto info = work.info("mesh.spm");
    for (const std::string name : {"mesh.npy", "mesh.vtu"}) {
      work.succeed("spillway convert -q mesh.spm -o " + name);
      const std::string read = name == "mesh.npy" ? "mesh_vertices.npy" : name;
      work.succeed("spillway convert -q " + read + " -o back.spm");
      for (const std::string& file : {read, std::string("back.spm")}) {
        const auto told = work.info(file);
        for (const char* key : {"vertices", "simplices", "hull_facets", "canonical_hash",
                                "periodic", "input_index", "extent"}) {
          EXPECT_EQ(told[key], info[key]) << file << ' ' << key;
        }
        EXPECT_EQ(told["on_lattice"], made.has_lattice && name == "mesh.vtu");
        EXPECT_THAT(work.succeed("spillway check -q " + file),
                    AllOf(HasSubstr("in the periodic box"), HasSubstr("proved to be")));
      }
    }
  }
}

TEST(PeriodicFormats, InfoTellsTheBox) {
  const Workspace work;
  triangulate(work, cases()[2]);
  EXPECT_EQ(work.info("mesh.spm")["periodic"],
            (nlohmann::json{{"min", {0.0, 0.0, nullptr}}, {"max", {8.0, 8.0, nullptr}}}));
  EXPECT_THAT(
      work.succeed("spillway info -q mesh.spm"),
      AllOf(HasSubstr("periodic min     0  0  -\n"), HasSubstr("periodic max     8  8  -\n")));
  work.succeed("spillway triangulate -q in.las --dim 3 -o other.spm");
  EXPECT_TRUE(work.info("other.spm")["periodic"].is_null());
}

TEST(PeriodicFormats, WhatCannotHoldItRefusesIt) {
  const Workspace work;
  triangulate(work, cases()[0]);
  work.succeed("spillway convert -q mesh.spm -o mesh.vtu");
  for (const std::string mesh : {"mesh.spm", "mesh.vtu"}) {
    for (const std::string file : {"a.ply", "a.obj", "a.off", "a.sma", "a.stl", "a.glb"}) {
      EXPECT_THAT(messages_of(work, "spillway convert -q " + mesh + " -o " + file, 2),
                  AllOf(HasSubstr("cannot hold a periodic mesh, whose triangles cross"),
                        HasSubstr("choose spm, vtu or npy")));
    }
    EXPECT_THAT(
        messages_of(work, "spillway convert -q " + mesh + " -o 'a_{x}_{y}.spm' --tiles 0.5", 2),
        HasSubstr("not written in tiles or clipped"));
    for (const std::string command :
         {"render {} -o a.png", "render {} -o a.html", "volume {} --level 0"}) {
      EXPECT_THAT(
          messages_of(work, "spillway " + fmt::format(fmt::runtime(command), mesh) + " -q", 2),
          HasSubstr("cannot be made of a periodic triangulation"));
    }
  }
}

TEST(PeriodicFormats, RefutesAMeshWhoseBoxIsAnother) {
  const Workspace work;
  triangulate(work, cases()[0]);
  work.succeed("spillway convert -q mesh.spm -o mesh.vtu");
  std::string vtu = work.read("mesh.vtu");
  const std::string high = ">1 1</DataArray>";
  const std::size_t at = vtu.find(high);
  ASSERT_NE(at, std::string::npos);
  vtu[at + 1] = '2';
  work.write("mesh.vtu", vtu);
  EXPECT_THAT(messages_of(work, "spillway check -q mesh.vtu", 1), HasSubstr("NOT"));
  vtu[at + 1] = '0';
  work.write("mesh.vtu", vtu);
  for (const char* command : {"check", "info"}) {
    EXPECT_THAT(messages_of(work, fmt::format("spillway {} -q mesh.vtu", command), 1),
                AllOf(HasSubstr("mesh.vtu"), HasSubstr("no length along x")));
  }
}

}  // namespace
}  // namespace spillway::test

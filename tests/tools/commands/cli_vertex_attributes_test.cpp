// What points carry, at the vertices of their mesh.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// The words of the lines of an ASCII PLY's vertices.
std::vector<std::vector<std::string>> vertices_of(const std::string& ply) {
  std::istringstream text(ply);
  std::uint64_t count = 0;
  std::string line;
  while (std::getline(text, line) && line != "end_header") {
    if (line.starts_with("element vertex ")) count = std::stoull(line.substr(15));
  }
  std::vector<std::vector<std::string>> vertices;
  while (vertices.size() < count && std::getline(text, line)) {
    std::istringstream words(line);
    std::vector<std::string>& vertex = vertices.emplace_back();
    for (std::string word; words >> word;) vertex.push_back(word);
  }
  return vertices;
}

/// Points on few places whose attribute `number` is their index.
void write_numbered_points(const Workspace& work, int count) {
  std::string csv = "x,y,z,number,tenth\n";
  for (int i = 0; i < count; ++i) {
    const int place = (i * 7919) % (count / 2 + 1);
    csv += fmt::format("{},{},{},{},{}\n", place % 71, place / 71, (i * 37) % 101, i, 0.1 * i);
  }
  work.write("in.csv", csv);
}

void expect_numbers_are_indices(const Workspace& work, const std::string& ply) {
  const auto vertices = vertices_of(work.read(ply));
  EXPECT_GT(vertices.size(), 100U);
  for (const auto& vertex : vertices) {  // x, y, z, the index, number, tenth
    ASSERT_EQ(vertex.size(), 6U);
    EXPECT_EQ(vertex[3], vertex[4]);
    EXPECT_DOUBLE_EQ(std::stod(vertex[5]), 0.1 * std::stod(vertex[3]));
  }
}

TEST(VertexAttributes, AreThoseOfThePointWhoseHeightAVertexHas) {
  const Workspace work;
  write_numbered_points(work, 4000);
  for (const char* choice : {"first", "lowest", "highest", "mean"}) {
    for (const char* how : {"", "--tile-points 300 --leaf-points 60 --memory 32M", "--threads 1"}) {
      SCOPED_TRACE(fmt::format("{} {}", choice, how));
      work.succeed(
          fmt::format("spillway triangulate -q in.csv -o m.ply --output-format ply-ascii --id "
                      "--attributes all --heights {} {}",
                      choice, how));
      expect_numbers_are_indices(work, "m.ply");
    }
  }
  work.succeed(
      "spillway triangulate -q in.csv -o m.ply --output-format ply-ascii --id --attributes all "
      "--dim 3");
  expect_numbers_are_indices(work, "m.ply");
}

TEST(VertexAttributes, GoThroughEveryFormatThatHoldsThem) {
  const Workspace work;
  write_numbered_points(work, 1000);
  work.succeed("spillway triangulate -q in.csv -o m.spm --id --attributes all");
  for (const std::string format : {"spm", "ply", "vtu", "npy"}) {
    work.succeed(fmt::format("spillway convert -q m.spm -o there.{}", format));
    work.succeed(
        fmt::format("spillway convert -q there.{} -o back.ply --output-format ply-ascii", format));
    expect_numbers_are_indices(work, "back.ply");
  }
  const nlohmann::json number = {{"name", "number"}, {"type", "float64"}};
  EXPECT_EQ(work.info("m.spm")["attributes"][0], number);
  EXPECT_EQ(work.info("there.vtu")["attributes"][0], number);
  work.succeed(
      "spillway convert -q m.spm -o some.ply --output-format ply-ascii --attributes tenth");
  EXPECT_EQ(vertices_of(work.read("some.ply")).front().size(), 5U);
  work.succeed("spillway convert -q m.spm -o none.ply --output-format ply-ascii --attributes none");
  EXPECT_EQ(vertices_of(work.read("none.ply")).front().size(), 4U);
  EXPECT_EQ(work.info("none.ply")["canonical_hash"], work.info("m.spm")["canonical_hash"]);
}

TEST(VertexAttributes, OfPlyAreTheColourUnlessAskedOtherwise) {
  const Workspace work;
  work.write("in.ply",
             "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
             "property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
             "property float curvature\nend_header\n"
             "0 0 1 10 20 30 0.5\n1 0 2 11 21 31 0.5\n0 1 3 12 22 32 0.5\n1 1 4 13 23 33 0.5\n");
  const std::string ascii = " --output-format ply-ascii";
  work.succeed("spillway triangulate -q in.ply -o m.ply" + ascii);
  EXPECT_THAT(work.read("m.ply"),
              AllOf(HasSubstr("property uchar red\n"), HasSubstr("\n1 1 4 13 23 33\n"),
                    Not(HasSubstr("curvature"))));
  work.succeed("spillway triangulate -q in.ply -o m.ply --attributes none" + ascii);
  EXPECT_THAT(work.read("m.ply"), Not(HasSubstr("red")));
  work.succeed("spillway triangulate -q in.ply -o m.ply --attributes curvature" + ascii);
  EXPECT_THAT(work.read("m.ply"),
              AllOf(HasSubstr("property float curvature\n"), Not(HasSubstr("red"))));
  work.succeed("spillway triangulate -q in.ply -o m.spm");
  work.succeed("spillway convert -q m.spm -o m.ply" + ascii);
  EXPECT_THAT(work.read("m.ply"), Not(HasSubstr("red")));
  work.succeed("spillway triangulate -q in.ply -o m.glb --attributes all");
  EXPECT_THAT(work.read("m.glb"), HasSubstr("COLOR_0"));
}

TEST(VertexAttributes, ThatAFormatDoesNotHoldAreNamed) {
  const Workspace work;
  write_numbered_points(work, 1000);
  const Result named = work.run("spillway triangulate in.csv -o m.obj --attributes number");
  EXPECT_EQ(named.exit_code, 2);
  EXPECT_THAT(named.err,
              HasSubstr("vertices of OBJ do not hold number: write spm, ply, vtu or npy"));
  const Result all =
      work.run("spillway triangulate in.csv -o m.obj --attributes all --stats stats.json");
  EXPECT_EQ(nlohmann::json::parse(work.read("stats.json"))["lost"],
            (std::vector<std::string>{"number", "tenth"}));
  EXPECT_EQ(all.exit_code, 0);
  EXPECT_THAT(all.err, HasSubstr("not kept: number, tenth"));
  EXPECT_THAT(work.run("spillway triangulate -q in.csv -o m.obj").err, IsEmpty());
  work.succeed("spillway triangulate -q in.csv -o m.spm --attributes all");
  EXPECT_THAT(work.run("spillway convert m.spm -o m.stl").err,
              HasSubstr("not kept: number, tenth"));
  const Result unknown = work.run("spillway triangulate in.csv -o x.spm --attributes colour");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err,
              HasSubstr("the points have no attribute \"colour\": choose of number, tenth"));
  EXPECT_FALSE(work.has("x.spm"));
}

}  // namespace
}  // namespace spillway::test

// Points of four to six dimensions: how files tell their coordinates, and what becomes of them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// An npy file of version 1.
std::string npy(const std::string& type, const std::string& shape, const std::string& data) {
  std::string header =
      fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': ({}), }}", type, shape);
  header.resize(118 - 1, ' ');
  header += '\n';
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header +
         data;
}

template <typename T>
std::string bytes_of(const std::vector<T>& numbers) {
  std::string bytes(numbers.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

/// Points (i, i^2, i^3, i^4) mod 31: of any five, few lie in one hyperplane.
std::vector<std::vector<std::int64_t>> curve_points(int count) {
  std::vector<std::vector<std::int64_t>> points;
  for (std::int64_t i = 1; i <= count; ++i) {
    points.push_back({i % 31, i * i % 31, i * i * i % 31, i * i * i * i % 31});
  }
  return points;
}

template <typename T>
std::string columns_of(const std::vector<std::vector<std::int64_t>>& points) {
  std::vector<T> numbers;
  for (const auto& point : points) {
    for (const std::int64_t coordinate : point) numbers.push_back(static_cast<T>(coordinate));
  }
  return bytes_of(numbers);
}

class HigherDimensions : public ::testing::Test {
 protected:
  std::string hash_of(const std::string& input, const std::string& options = "") const {
    work_.succeed(fmt::format("spillway triangulate -q --dim 4 {} {} -o m.spm", input, options));
    return work_.info("m.spm").at("canonical_hash");
  }
  void expect_error(const std::string& arguments, const std::string& message) const {
    const Result result = work_.run("spillway " + arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    EXPECT_THAT(result.err, HasSubstr(message));
  }

  Workspace work_;
};

TEST_F(HigherDimensions, AreReadFromEveryKindOfFile) {
  const auto points = curve_points(30);
  work_.write("f8.npy", npy("'<f8'", "30, 4", columns_of<double>(points)));
  work_.write("f4.npy", npy("'<f4'", "30, 4", columns_of<float>(points)));
  work_.write("i2.npy", npy("'<i2'", "30, 4", columns_of<std::int16_t>(points)));
  work_.write("i8.npy", npy("'<i8'", "30, 4", columns_of<std::int64_t>(points)));
  work_.write("fields.npy",
              npy("[('x4', '<f8'), ('y', '<f8'), ('z', '<f8'), ('x', '<f8')]", "30,", [&] {
                auto turned = points;
                for (auto& p : turned) std::swap(p[0], p[3]);
                return columns_of<double>(turned);
              }()));
  std::string csv = "x,y,z,x4\n";
  for (const auto& point : points) csv += fmt::format("{}\n", fmt::join(point, ","));
  work_.write("points.csv", csv);
  work_.succeed("spillway convert -q points.csv -o points.spp --attributes all");
  work_.succeed("spillway convert -q points.csv -o again.npy --attributes all");
  EXPECT_EQ(work_.read("again.npy").substr(128), work_.read("f8.npy").substr(128));
  const std::string hash = hash_of("f8.npy");
  for (const char* file : {"f4.npy", "i2.npy", "i8.npy", "fields.npy", "points.csv", "points.spp",
                           "again.npy", "- < f8.npy"}) {
    EXPECT_EQ(hash_of(file), hash) << file;
  }
}

TEST_F(HigherDimensions, AreProvedAndTold) {
  work_.succeed("spillway generate -q uniform -n 900 --dim 4 -o in.npy");
  work_.succeed("spillway triangulate -q --dim 4 in.npy -o m.spm --stats run.json");
  const auto run = nlohmann::json::parse(work_.read("run.json"));
  EXPECT_EQ(run["dimension"], 4);
  EXPECT_GE(run["border_simplices"], 0);
  const auto mesh = work_.info("m.spm");
  EXPECT_EQ(mesh["dimension"], 4);
  EXPECT_EQ(mesh["vertices"], 900);
  EXPECT_EQ(mesh["extent"]["min"].size(), 4U);
  EXPECT_GT(mesh["extent"]["max"][3], 0.9);
  const std::string proof = work_.succeed("spillway check -q m.spm --points in.npy");
  EXPECT_THAT(proof, HasSubstr("the vertices are the 900 distinct points of the input"));
  work_.succeed("spillway generate -q uniform -n 900 --dim 4 --seed 2 -o other.npy");
  EXPECT_EQ(work_.run("spillway check -q m.spm --points other.npy").exit_code, 1);
}

TEST_F(HigherDimensions, OfLatticesHaveOneMeshWhateverTheMemoryAndTheThreads) {
  work_.succeed("spillway generate -q lattice -n 4096 --dim 4 -o in.npy");
  const std::string hash = hash_of("in.npy");
  EXPECT_EQ(hash_of("in.npy", "--threads 1 --tile-points 600 --leaf-points 300"), hash);
  EXPECT_EQ(hash_of("in.npy", "--threads 2 --tile-points 1500"), hash);
  EXPECT_THAT(work_.succeed("spillway check -q m.spm --points in.npy"),
              HasSubstr("ties broken canonically"));
}

TEST_F(HigherDimensions, KeepOtherAttributesAndIndicesOfPoints) {
  auto points = curve_points(30);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].push_back(static_cast<int>(i));
  work_.write("in.npy", npy("'<i4'", "30, 5", columns_of<std::int32_t>(points)));
  const std::string hash = hash_of("in.npy", "--id --attributes column_5");
  const auto attributes = work_.info("m.spm")["attributes"];
  ASSERT_EQ(attributes.size(), 2U);
  EXPECT_EQ(attributes[0]["name"], "column_4");
  EXPECT_EQ(attributes[0]["type"], "float64");
  EXPECT_EQ(attributes[1]["name"], "column_5");
  EXPECT_EQ(attributes[1]["type"], "int32");
  work_.succeed("spillway convert -q m.spm -o mesh.npy");
  EXPECT_THAT(work_.read("mesh_vertices.npy"), HasSubstr("(30, 4)"));
  EXPECT_THAT(work_.read("mesh_simplices.npy"), HasSubstr(", 5)"));
  EXPECT_EQ(work_.info("mesh.npy")["canonical_hash"], hash);
  work_.succeed("spillway check -q mesh.npy --points in.npy");
  work_.succeed("spillway convert -q mesh.npy -o back.spm");
  EXPECT_EQ(work_.info("back.spm")["canonical_hash"], hash);
  EXPECT_EQ(work_.info("back.spm")["attributes"].size(), 2U);
}

TEST_F(HigherDimensions, StayWhereOtherAttributesAreLeftOut) {
  auto points = curve_points(30);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].push_back(static_cast<int>(100 + i));
  work_.write("in.npy", npy("'<f8'", "30, 5", columns_of<double>(points)));
  const std::string hash = hash_of("in.npy", "--attributes column_5");
  for (const char* attributes : {"none", "column_5", "all"}) {
    for (const char* file : {"out.spm", "out.npy"}) {
      work_.succeed(fmt::format("rm -f out*\nspillway convert -q m.spm -o {} --attributes {}", file,
                                attributes));
      EXPECT_EQ(work_.info(file)["canonical_hash"], hash) << file << " " << attributes;
      EXPECT_EQ(work_.info(file)["attributes"].size(), std::string(attributes) == "none" ? 1U : 2U);
    }
  }
}

TEST_F(HigherDimensions, OfInputsThatNameThemDifferentlyAreOneSet) {
  work_.succeed(
      "spillway generate -q uniform -n 200 --dim 4 -o a.spp\n"
      "spillway generate -q uniform -n 200 --dim 4 --seed 2 -o b.npy\n"
      "spillway convert -q b.npy -o b.spp --attributes all\n"
      "spillway generate -q uniform -n 200 --dim 4 --seed 2 -o b4.spp");
  const std::string hash = hash_of("a.spp b4.spp");
  EXPECT_EQ(hash_of("a.spp b.npy"), hash);
  EXPECT_EQ(hash_of("b.npy a.spp", "--attributes all"), hash);
  EXPECT_EQ(work_.info("m.spm")["attributes"].size(), 1U);
  work_.succeed("spillway check -q m.spm --points a.spp b.npy");
}

TEST_F(HigherDimensions, GoToEveryFormatOfPointsThatHoldsThem) {
  work_.succeed("spillway generate -q uniform -n 50 --dim 5 -o a.spp");
  const std::string info = "spillway triangulate -q --dim 5 {} -o {}.spm";
  work_.succeed(fmt::format(fmt::runtime(info), "a.spp", "a"));
  for (const char* file : {"b.csv", "b.xyz", "b.ply", "b.npy"}) {
    work_.succeed(fmt::format("spillway generate -q uniform -n 50 --dim 5 -o {}", file));
    work_.succeed(fmt::format(fmt::runtime(info), file, "b"));
    EXPECT_EQ(work_.info("b.spm")["canonical_hash"], work_.info("a.spm")["canonical_hash"]) << file;
  }
}

TEST_F(HigherDimensions, OfAllFamiliesAreMade) {
  for (const char* family : {"uniform", "normal", "bubbles", "ellipsoid", "lines", "lattice",
                             "circle", "clusters", "duplicates", "utm"}) {
    for (const int dimension : {4, 6}) {
      work_.succeed(
          fmt::format("spillway generate -q {0} -n 64 --dim {1} -o in.spp\n"
                      "spillway generate -q {0} -n 64 --dim {1} -o in.npy\n"
                      "spillway convert -q in.spp -o same.npy --attributes all\n"
                      "cmp in.npy same.npy",
                      family, dimension));
      EXPECT_EQ(work_.info("in.spp")["attributes"].size(), dimension - 3U);
      if (dimension > 4 || std::string("duplicates") == family) continue;  // of too few places
      work_.succeed(fmt::format("spillway triangulate -q --dim {} in.spp -o a.spm", dimension));
    }
  }
  expect_error("generate packing -n 10 --dim 4 -o a.npy", "'packing' has 2 or 3 dimensions, not 4");
  expect_error("generate uniform -n 10 --dim 4 --grid 2x2 -o a_#.npy", "2 or 3 dimensions");
}

TEST_F(HigherDimensions, ThatAPointLacksAreAnErrorWithItsNumber) {
  auto points = curve_points(30);
  std::vector<double> numbers(120);
  std::memcpy(numbers.data(), columns_of<double>(points).data(), 960);
  numbers[4 * 17 + 3] = std::numeric_limits<double>::quiet_NaN();
  work_.write("nan.npy", npy("'<f8'", "30, 4", bytes_of(numbers)));
  expect_error("triangulate --dim 4 nan.npy -o a.spm",
               "nan.npy: point 17 has the coordinate nan (column_4), which is not finite");
  points[5][3] = (std::int64_t{1} << 53) + 1;
  work_.write("large.npy", npy("'<i8'", "30, 4", columns_of<std::int64_t>(points)));
  expect_error("triangulate --dim 4 large.npy -o a.spm",
               "point 5 has the coordinate 9007199254740992 (column_4), which is of an integer of "
               "2^53 or beyond");
  EXPECT_FALSE(work_.has("a.spm"));
  for (const char* file : {"nan.npy", "large.npy"}) {
    const Result result =
        work_.run(fmt::format("spillway triangulate --dim 4 {} -o a.spm --skip-invalid", file));
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.err, HasSubstr("1 invalid, 29 kept"));
  }
  work_.succeed("spillway generate -q uniform -n 90 --dim 3 -o space.npy");
  expect_error("triangulate --dim 4 space.npy -o b.spm",
               "the points have no coordinate 4 of 4 dimensions: no attribute called x4");
  work_.succeed("spillway generate -q uniform -n 90 --dim 4 -o four.npy");
  expect_error("triangulate --dim 4 four.npy space.npy -o b.spm", "space.npy: ");
  expect_error("triangulate --dim 5 four.npy -o b.spm", "no coordinate 5 of 5 dimensions");
}

TEST_F(HigherDimensions, AreRefusedWhereTheyCannotBe) {
  work_.succeed("spillway generate -q uniform -n 90 --dim 4 -o in.npy");
  for (const char* file : {"a.ply", "a.vtu", "a.stl", "a.obj"}) {
    expect_error(fmt::format("triangulate --dim 4 in.npy -o {}", file),
                 "no simplices of 4 dimensions; choose spm or npy");
  }
  expect_error("triangulate --dim 7 in.npy -o a.spm", "7 not in {2,3,4,5,6}");
  expect_error("triangulate --dim 4 in.npy -o a.spm --heights mean", "no effect with --dim 4");
  expect_error("triangulate --dim 4 in.npy -o a.spm --thin 1", "thinned by cells of 2 or 3");
  expect_error("triangulate --dim 4 in.npy -o a.spm --kernel cgal", "in 2 and 3 dimensions");
  hash_of("in.npy");
  expect_error("render m.spm -o a.png", "simplices of 4 dimensions");
  expect_error("dem m.spm -o a.tif --resolution 1", "a terrain is a mesh of triangles");
  EXPECT_THAT(work_.names(), ElementsAre("in.npy", "m.spm"));
}

TEST_F(HigherDimensions, AreTriangulatedInLittleMemory) {
  work_.succeed("spillway generate -q uniform -n 25000 --dim 4 -o in.npy");
  const std::string hash = hash_of("in.npy");
  EXPECT_EQ(hash_of("in.npy", "--memory 128M --stats run.json"), hash);
  const auto run = nlohmann::json::parse(work_.read("run.json"));
  EXPECT_GT(run["leaves"], 1);
  EXPECT_GT(run["border_simplices"], 10'000);
  expect_error("triangulate --dim 4 in.npy -o a.spm --memory 64M",
               "128 MiB are the least in four dimensions");
}

TEST_F(HigherDimensions, GoOnAfterARunThatWasKilled) {
  work_.succeed("spillway generate -q uniform -n 20000 --dim 4 -o in.npy");
  const std::string options = "--tile-points 2500 --threads 2";
  work_.succeed(fmt::format("spillway triangulate -q --dim 4 in.npy {} -o whole.spm", options));
  static_cast<void>(work_.run(
      fmt::format("timeout -s KILL 0.5 spillway triangulate -q --dim 4 in.npy {} -o a.spm --resume "
                  "state --checkpoint-every 0.01",
                  options)));
  work_.succeed(
      fmt::format("spillway triangulate -q --dim 4 in.npy {} -o a.spm --resume state", options));
  EXPECT_EQ(work_.info("a.spm")["canonical_hash"], work_.info("whole.spm")["canonical_hash"]);
  work_.succeed("spillway check -q a.spm --points in.npy");
}

TEST_F(HigherDimensions, HaveNoFileOfAttributesAmongTheNpyArraysForTheirCoordinates) {
  work_.succeed("spillway generate -q uniform -n 200 --dim 4 -o in.npy");
  work_.succeed("spillway triangulate -q --dim 4 in.npy -o a.npy --resume state");
  EXPECT_EQ(work_.succeed("ls a*"), "a_simplices.npy\na_vertices.npy\n");
  work_.write("a_attributes.npy", "of an earlier mesh");
  expect_error("triangulate --dim 4 in.npy -o a.npy", "a_attributes.npy of an earlier mesh");
}

}  // namespace
}  // namespace spillway::test
